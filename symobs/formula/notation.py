"""The vocabulary: every letter with its LaTeX and plain form, and the names of functions.

Letters: n, m, p states, inputs, outputs; K feedback, L observer, always; 𝒪, 𝒞; χ characteristic, φ desired
polynomial; x̂ estimate, e = x − x̂ error.  A polynomial's letter carries its variable, `s` or `z`.
"""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


__all__ = [
    "FUNCTIONS",
    "GREEK",
    "GREEK_LATEX",
    "GREEK_LETTERS",
    "LETTERS",
    "OPERATORS",
    "SIGNALS",
    "SUBSCRIPTS",
    "TIMED",
    "LetterForm",
    "is_of_time",
    "printed_alike",
    "sans_serif",
    "shows_time",
    "symbol_latex",
    "symbol_text",
]


@dataclass
class LetterForm:
    """The forms of a letter: LaTeX, terminal, words.  `{v}` stands for the polynomial's variable."""

    latex: str
    text: str
    spoken: str

    @property
    def alone(self) -> LetterForm:
        """The form without the variable: of the function, not of its values."""
        return LetterForm(self.latex.replace("({v})", ""), self.text.replace("({v})", ""), self.spoken)


LETTERS: dict[str, LetterForm] = {
    "A": LetterForm("A", "A", "state matrix"),
    "B": LetterForm("B", "B", "input matrix"),
    "C": LetterForm("C", "C", "output matrix"),
    "D": LetterForm("D", "D", "feedthrough matrix"),
    "f_x": LetterForm("f", "f", "rate of change of the states"),
    "h_x": LetterForm("h", "h", "output as a function of the states"),
    "lagrange": LetterForm(
        r"\mathrm d/\mathrm dt(\partial T/\partial\dot q)-\partial T/\partial q+\partial V/\partial q=Q",
        "d/dt(∂T/∂q̇) - ∂T/∂q + ∂V/∂q = Q",
        "Lagrange's equation",
    ),
    "T_q": LetterForm("T", "T", "kinetic energy"),
    "V_q": LetterForm("V", "V", "potential energy"),
    "Q_q": LetterForm("Q", "Q", "generalised forces"),
    **{f"p_q{k}": LetterForm(f"p_{k}", f"p{'₀₁₂₃₄₅₆₇₈₉'[k]}", "generalised momentum") for k in range(1, 10)},
    "M_q": LetterForm("M(q)", "M(q)", "matrix of the highest derivatives in the equations of motion"),
    **{
        f"A_e{k}": LetterForm(rf"A_{k}", f"A{'₀₁₂₃₄₅₆₇₈₉'[k]}", "matrix of the linearisation at an equilibrium")
        for k in range(1, 10)
    },
    **{
        f"{x}_e{k}": LetterForm(
            rf"{x}_{k}^{{*}}" if x != "g" else f"g_{k}",
            f"{x}{'' if x == 'g' else '*'}{'₀₁₂₃₄₅₆₇₈₉'[k]}",
            f"{meaning} at an equilibrium",
        )
        for x, meaning in (("x", "states"), ("u", "inputs"), ("g", "what is left of f"))
        for k in range(1, 10)
    },
    **{
        f"chi_e{k}": LetterForm(
            rf"\chi_{k}({{v}})", f"χ{'₀₁₂₃₄₅₆₇₈₉'[k]}({{v}})", f"characteristic polynomial of A_{k}"
        )
        for k in range(1, 10)
    },
    "partial": LetterForm(r"\partial", "∂", "sign of a partial derivative"),
    "K": LetterForm("K", "K", "state feedback gain"),
    "L": LetterForm("L", "L", "observer gain"),
    "O": LetterForm(r"\mathcal O", "𝒪", "observability matrix"),
    "Ctr": LetterForm(r"\mathcal C", "𝒞", "controllability matrix"),
    "V_o": LetterForm(r"V_{\mathrm o}", "V_o", "transformation of the dual pair to canonical form"),
    "V_c": LetterForm(r"V_{\mathrm c}", "V_c", "transformation to canonical form"),
    "A_c": LetterForm(r"A_{\mathrm c}", "A_c", "compensator matrix"),
    "A_dual": LetterForm(r"A_{\mathrm d}", "A_d", "state matrix of the dual"),
    "B_dual": LetterForm(r"B_{\mathrm d}", "B_d", "input matrix of the dual"),
    "C_dual": LetterForm(r"C_{\mathrm d}", "C_d", "output matrix of the dual"),
    "D_dual": LetterForm(r"D_{\mathrm d}", "D_d", "feedthrough matrix of the dual"),
    "O_dual": LetterForm(r"\mathcal O_{\mathrm d}", "𝒪_d", "observability matrix of the dual"),
    "Ctr_dual": LetterForm(r"\mathcal C_{\mathrm d}", "𝒞_d", "controllability matrix of the dual"),
    "A_cl": LetterForm(r"A_{\mathrm{cl}}", "A_cl", "closed-loop matrix"),
    "q_o": LetterForm(r"q_{\mathrm o}", "q_o", "last column of the inverse observability matrix"),
    "q_c": LetterForm(r"q_{\mathrm c}", "q_c", "last row of the inverse controllability matrix"),
    "v": LetterForm("v", "v", "vector"),
    "N": LetterForm("N", "N", "basis of the unobservable subspace"),
    "X": LetterForm("X", "X", "restriction of A to the unobservable subspace"),
    "N_K": LetterForm(r"N_{\mathrm c}", "N_c", "basis of the left kernel of the controllability matrix, transposed"),
    "X_K": LetterForm(r"X_{\mathrm c}", "X_c", "restriction of the transpose of A to that kernel"),
    "N_2": LetterForm("N_2", "N₂", "basis of the unobservable subspace of the unmeasured subsystem"),
    "X_2": LetterForm("X_2", "X₂", "restriction of A to the unobservable subspace of the unmeasured part"),
    "exp_At": LetterForm("e^{At}", "exp(A t)", "matrix exponential"),
    "A_k": LetterForm("A^k", "Aᵏ", "power of the state matrix"),
    "x_k": LetterForm("x(k)", "x(k)", "state at the instant k"),
    "y_k": LetterForm("y(k)", "y(k)", "output at the instant k"),
    "u_k": LetterForm("u(k)", "u(k)", "input at the instant k"),
    "Phi_T": LetterForm("e^{AT}", "exp(A T)", "matrix exponential over the horizon"),
    "A_zoh": LetterForm(r"A_{\mathrm d}", "A_d", "state matrix of the sampled plant"),
    "B_zoh": LetterForm(r"B_{\mathrm d}", "B_d", "input matrix of the sampled plant"),
    "C_zoh": LetterForm(r"C_{\mathrm d}", "C_d", "output matrix of the sampled plant"),
    "D_zoh": LetterForm(r"D_{\mathrm d}", "D_d", "feedthrough of the sampled plant"),
    "F_zoh": LetterForm(r"F_{\mathrm d}(z)", "F_d(z)", "controller in discrete time"),
    "n_F": LetterForm("n_F({v})", "n_F({v})", "numerator of the controller"),
    "d_F": LetterForm("d_F({v})", "d_F({v})", "denominator of the controller"),
    "Y": LetterForm("Ce^{At}", "C exp(A t)", "output of the matrix exponential"),
    "W": LetterForm("W", "W", "Gramian"),
    "M": LetterForm("M", "M", "finite sum"),
    "y_t": LetterForm("y(t)", "y(t)", "measured output"),
    "u_t": LetterForm("u(t)", "u(t)", "known input"),
    "y_0": LetterForm(r"\tilde y(t)", "ỹ(t)", "output without the input's part"),
    "x_f": LetterForm(r"x_{\mathrm f}(t)", "x_f(t)", "state from rest"),
    "x_0": LetterForm("x_0", "x₀", "initial state"),
    "x_1f": LetterForm(r"x_{\mathrm f}", "x_f", "final state"),
    "T_h": LetterForm("T", "T", "horizon"),
    "Phi_b": LetterForm("e^{A(T-t)}", "exp(A (T - t))", "matrix exponential backwards from the end of the horizon"),
    "d_r": LetterForm("d", "d", "difference of the final state to the zero-input response"),
    "lam_e": LetterForm(r"\lambda", "λ", "solution of the equation of the Gramian"),
    "U_k": LetterForm("U", "U", "input sequence"),
    "E_u": LetterForm("E", "E", "energy of the input"),
    "A_hat": LetterForm(r"\hat A", "Â", "state matrix of plant and integrator or exosystem"),
    "B_hat": LetterForm(r"\hat B", "B̂", "input matrix of plant and integrator or exosystem"),
    "k_I": LetterForm(r"k_{\mathrm I}", "k_I", "gain of the integrated control error"),
    "xi_I": LetterForm(r"\xi", "ξ", "integral of the control error"),
    "r_in": LetterForm("r", "r", "reference input"),
    "r_0": LetterForm("r", "r", "right side of the moment equations"),
    "Q": LetterForm("Q", "Q", "intensity of the input noise"),
    "det_W": LetterForm(r"\det W(t)", "det W(t)", "determinant of the Gramian up to t"),
    "W_t": LetterForm("W(t)", "W(t)", "Gramian up to t"),
    "Phi_m": LetterForm("e^{-At}", "exp(-A t)", "inverse of the matrix exponential"),
    "V_t": LetterForm("V(t)", "V(t)", "what input noise at t does to the estimate"),
    "S_R": LetterForm("S_R", "S_R", "output noise between the inverse Gramians"),
    "S_Q": LetterForm("S_Q", "S_Q", "input noise between the inverse Gramians"),
    "Cov_R": LetterForm(r"\Sigma_R", "Σ_R", "covariance from the output noise"),
    "Cov_Q": LetterForm(r"\Sigma_Q", "Σ_Q", "covariance from the input noise"),
    **{f"var_{k}": LetterForm(rf"\sigma_{k}^2", f"σ{'₀₁₂₃'[k]}²", "variance of a component") for k in (1, 2, 3)},
    "Cov": LetterForm(r"\Sigma", "Σ", "covariance of the estimated initial state"),
    "P_l": LetterForm("P", "P", "solution of Lyapunov's equation"),
    "Q_l": LetterForm("Q", "Q", "right-hand side of Lyapunov's equation"),
    "N_l": LetterForm("N", "N", "solution of the homogeneous Lyapunov equation"),
    "X_l": LetterForm("X", "X", "what shows that Lyapunov's equation has no solution"),
    "Q_x": LetterForm("Q", "Q", "weight of the state"),
    "R_u": LetterForm("R", "R", "weight of the input"),
    "N_x": LetterForm("N", "N", "weight of the products of state and input"),
    "Q_N": LetterForm("Q_N", "Q_N", "weight of the state without the cross weight"),
    "A_N": LetterForm("A_N", "A_N", "state matrix without the cross weight"),
    "P_x": LetterForm("P", "P", "stabilizing solution of Riccati's equation"),
    "W_n": LetterForm("W", "W", "intensity of the input noise"),
    "V_n": LetterForm("V", "V", "intensity of the output noise"),
    "G_n": LetterForm("G", "G", "input matrix of the noise"),
    "v_s": LetterForm("v({v})", "v({v})", "numerators from the input to the states"),
    "v_m": LetterForm("v(-{v})", "v(-{v})", "numerators at the mirror image"),
    "chi_m": LetterForm(r"\chi(-{v})", "χ(-{v})", "characteristic polynomial at the mirror image"),
    "c_even": LetterForm("c({v})", "c({v})", "polynomial of the optimal loop times its mirror image"),
    "c_rho": LetterForm(r"c_\rho({v})", "c_ρ({v})", "the same polynomial with the weight multiplied by a factor"),
    "p_s": LetterForm("p({v})", "p({v})", "polynomial of the optimal loop"),
    "H_m": LetterForm("H", "H", "Hamiltonian matrix"),
    "P_r": LetterForm(r"\hat P", "P̂", "digits of the solution of Riccati's equation"),
    "K_r": LetterForm(r"\hat K", "K̂", "digits of the gain"),
    "N_n": LetterForm("N", "N", "expectation of the product of the noises"),
    "L_f": LetterForm(r"L_{\mathrm f}", "L_f", "gain after the measurement"),
    "P_f": LetterForm(r"P_{\mathrm f}", "P_f", "covariance of the error after the measurement"),
    "L_r": LetterForm(r"\hat L", "L̂", "digits of the gain"),
    "mu": LetterForm(r"\mu({v})", "μ({v})", "annihilating polynomial of the unobservable part"),
    "S": LetterForm("S", "S", "basis of the new coordinates"),
    "A_bar": LetterForm(r"\bar A", "Ā", "state matrix in the new coordinates"),
    "B_bar": LetterForm(r"\bar B", "B̄", "input matrix in the new coordinates"),
    "C_bar": LetterForm(r"\bar C", "C̄", "output matrix in the new coordinates"),
    "A_co": LetterForm(r"\bar A_{1}", "Ā₁", "state matrix of the minimal part"),
    "B_co": LetterForm(r"\bar B_{1}", "B̄₁", "input matrix of the minimal part"),
    "C_co": LetterForm(r"\bar C_{1}", "C̄₁", "output matrix of the minimal part"),
    "x": LetterForm("x", "x", "state"),
    "x_hat": LetterForm(r"\hat x", "x̂", "estimate"),
    "e": LetterForm("e", "e", "estimation error"),
    "u": LetterForm("u", "u", "input"),
    "y": LetterForm("y", "y", "output"),
    "y_hat": LetterForm(r"\hat y", "ŷ", "estimated output"),
    "s": LetterForm("{v}", "{v}", "variable"),
    "chi": LetterForm(r"\chi_A({v})", "χ_A({v})", "characteristic polynomial"),
    "chi_o": LetterForm(r"\chi_{\mathrm o}({v})", "χ_o({v})", "characteristic polynomial of the loop that is cut"),
    "chi_r": LetterForm(r"\chi_A^*({v})", "χ*_A({v})", "characteristic polynomial in reverse order"),
    "chi_K": LetterForm(r"\chi_{A-BK}({v})", "χ_(A-BK)({v})", "polynomial of the state feedback"),
    "chi_L": LetterForm(r"\chi_{A-LC}({v})", "χ_(A-LC)({v})", "polynomial of the error"),
    "chi_p": LetterForm(r"\chi({v})", "χ({v})", "polynomial"),
    "chi_cl": LetterForm(r"\chi_{\mathrm{cl}}({v})", "χ_cl({v})", "polynomial of the closed loop"),
    "q_s": LetterForm("q({v})", "q({v})", "polynomial with the boundary moved"),
    "q_w": LetterForm("q(w)", "q(w)", "polynomial transformed to the half-plane"),
    "q_v": LetterForm("q(v)", "q(v)", "polynomial transformed to the half-plane"),
    **{f"Delta_{k}": LetterForm(rf"\Delta_{k}", f"Δ{'₀₁₂₃₄₅₆₇₈₉'[k]}", "Hurwitz determinant") for k in range(1, 10)},
    "phi": LetterForm(r"\varphi({v})", "φ({v})", "desired polynomial"),
    "phi_c": LetterForm(r"\varphi_{\mathrm c}({v})", "φ_c({v})", "desired control polynomial"),
    "phi_o": LetterForm(r"\varphi_{\mathrm o}({v})", "φ_o({v})", "desired observer polynomial"),
    "phi_z": LetterForm(r"\varphi_{\mathrm z}({v})", "φ_z({v})", "polynomial of the stable zeros"),
    "phi_r": LetterForm(r"\varphi_{\mathrm r}({v})", "φ_r({v})", "polynomial of the remaining poles"),
    "sigma_d": LetterForm(r"\sigma", "σ", "distance of a dominant pair from the imaginary axis"),
    "omega_d": LetterForm(r"\omega_{\mathrm d}", "ω_d", "imaginary part of a dominant pair"),
    "T_s": LetterForm(r"T_{\mathrm s}", "T_s", "settling time"),
    "exp_sT": LetterForm(r"e^{-s T_{\mathrm t}}", "e^(−s T_t)", "transfer function of a dead time"),
    "T_t": LetterForm(r"T_{\mathrm t}", "T_t", "dead time"),
    "T_p": LetterForm(r"T_{\mathrm p}", "T_p", "dead time by a Padé approximation"),
    "M_p": LetterForm(r"M_{\mathrm p}", "M_p", "overshoot"),
    "b_P": LetterForm("b({v})", "b({v})", "numerator of the plant"),
    "F": LetterForm("F({v})", "F({v})", "compensator"),
    "T": LetterForm("T", "T", "change of coordinates"),
    "R": LetterForm("R", "R", "rows that complete the output matrix"),
    "A_11": LetterForm("A_{11}", "A₁₁", "block of the state matrix"),
    "A_12": LetterForm("A_{12}", "A₁₂", "block of the state matrix"),
    "A_21": LetterForm("A_{21}", "A₂₁", "block of the state matrix"),
    "A_22": LetterForm("A_{22}", "A₂₂", "block of the state matrix"),
    "B_1": LetterForm("B_1", "B₁", "block of the input matrix"),
    "B_2": LetterForm("B_2", "B₂", "block of the input matrix"),
    "F_z": LetterForm("F", "F", "matrix of the reduced-order observer"),
    "G_z": LetterForm("G", "G", "input matrix of the reduced-order observer"),
    "H_z": LetterForm("H", "H", "output matrix of the reduced-order observer"),
    "M_z": LetterForm("M", "M", "matrix that assembles the estimate"),
    "K_1": LetterForm("K_1", "K₁", "feedback from the measured states"),
    "K_2": LetterForm("K_2", "K₂", "feedback from the states that are not measured"),
    "K_y": LetterForm(r"K_{\mathrm y}", "K_y", "feedback from the output"),
    "W_u": LetterForm("W", "W", "what solves the control law for the input"),
    "A_ref": LetterForm(r"A_{\mathrm d}", "A_d", "matrix of the reference"),
    "K_d": LetterForm(r"K_{\mathrm d}", "K_d", "gain that leaves the reference out of the error"),
    "x_d": LetterForm(r"x_{\mathrm d}", "x_d", "reference"),
    "e_d": LetterForm(r"e_{\mathrm d}", "e_d", "tracking error"),
    "A_e": LetterForm(r"A_{\mathrm e}", "A_e", "matrix of the errors"),
    "x_d0": LetterForm(r"x_{\mathrm d}(0)", "x_d(0)", "start of the reference"),
    "V_d": LetterForm(r"V_{\mathrm d}", "V_d", "what the trajectory passes through"),
    "w_d": LetterForm("w", "w", "row that annihilates the input matrix"),
    "G_r": LetterForm(r"G_{\mathrm r}({v})", "G_r({v})", "loop with unity feedback"),
    "F_x": LetterForm("F", "F", "matrix of the observer"),
    "G_x": LetterForm("G", "G", "input matrix of the observer"),
    "H_x": LetterForm("H", "H", "output matrix of the observer"),
    "E_d": LetterForm("E", "E", "disturbance input matrix"),
    "S_w": LetterForm("S", "S", "state matrix of the exosystem"),
    "V_w": LetterForm("V", "V", "output matrix of the exosystem"),
    "Q_r": LetterForm("Q", "Q", "output matrix of the exosystem for the reference"),
    "Pi_w": LetterForm(r"\Pi", "Π", "state of the stationary response by the state of the exosystem"),
    "Gamma_w": LetterForm(r"\Gamma", "Γ", "input of the stationary response by the state of the exosystem"),
    "F_w": LetterForm("F", "F", "feedforward gain of the state of the exosystem"),
    "U_r": LetterForm("U", "U", "what shows that the regulator equations have no solution"),
    "V_r": LetterForm("V", "V", "what shows that the regulator equations have no solution"),
    "r_w": LetterForm("r", "r", "reference of the output"),
    "x_w": LetterForm(r"\tilde x", "x̃", "deviation of the state from the stationary response"),
    "w_e": LetterForm("w", "w", "state of the exosystem"),
    "w_hat": LetterForm(r"\hat w", "ŵ", "estimate of the state of the exosystem"),
    "d_hat": LetterForm(r"\hat d", "d̂", "estimate of the disturbance"),
    "e_w": LetterForm(r"e_{\mathrm w}", "e_w", "error of the estimate of the state of the exosystem"),
    "C_hat": LetterForm(r"\hat C", "Ĉ", "output matrix of plant and exosystem"),
    "L_x": LetterForm(r"L_{\mathrm x}", "L_x", "observer gain of the state"),
    "L_w": LetterForm(r"L_{\mathrm w}", "L_w", "observer gain of the state of the exosystem"),
    "E_1": LetterForm("E_1", "E₁", "independent columns of the disturbance input matrix"),
    "d": LetterForm("d", "d", "disturbance"),
    "H_d": LetterForm("H", "H", "output matrix of the unknown-input observer"),
    "T_d": LetterForm("T", "T", "what decouples the error from the unknown input"),
    "A_T": LetterForm("A_1", "A₁", "state matrix without the unknown input"),
    "F_d": LetterForm("F", "F", "state matrix of the unknown-input observer"),
    "L_y": LetterForm(r"B_{\mathrm y}", "B_y", "output matrix of the state of the unknown-input observer"),
    "F_v": LetterForm("F", "F", "feedforward"),
    "v_r": LetterForm("v", "v", "reference input"),
    "G_0": LetterForm("G_0", "G₀", "gain at rest"),
    "w_0": LetterForm("w", "w", "row that annihilates the DC gain"),
    "T_v": LetterForm("T({v})", "T({v})", "response to the reference input"),
    "B_c": LetterForm(r"B_{\mathrm c}", "B_c", "input matrix of the compensator"),
    **{f"xi_{k}": LetterForm(rf"\xi_{k}", f"ξ{'₀₁₂₃₄₅₆₇₈₉'[k]}", "null vector of a pole") for k in range(1, 10)},
    "Psi": LetterForm(r"\Psi", "Ψ", "upper parts of the null vectors"),
    "f_psi": LetterForm("f", "f", "lower parts of the null vectors"),
    **{
        f"{letter}_{side}": LetterForm(rf"{letter}_{{\mathrm {side}}}", f"{letter}_{side}", meaning)
        for side in "co"
        for letter, meaning in (
            ("F", "companion matrix of the desired polynomial"),
            ("G", "right factor of Sylvester's equation"),
            ("X", "solution of Sylvester's equation"),
        )
    },
    **{
        f"{letter}_{side}1": LetterForm(rf"{letter}_{{\mathrm {side}1}}", f"{letter}_{side}₁", meaning)
        for side in "co"
        for letter, meaning in (
            ("G", "right factor of Sylvester's equation for one gain"),
            ("X", "solution of Sylvester's equation for one gain"),
        )
    },
    "L_G": LetterForm("L(G)", "L(G)", "general observer gain"),
    "K_G": LetterForm("K(G)", "K(G)", "general state feedback gain"),
    "L_0": LetterForm("L_0", "L₀", "gain by which the plant is shifted"),
    "K_0": LetterForm("K_0", "K₀", "gain by which the plant is shifted"),
    "L_s": LetterForm(r"L_{\mathrm s}", "L_s", "observer gain with simple entries"),
    "K_s": LetterForm(r"K_{\mathrm s}", "K_s", "state feedback gain with simple entries"),
    **{f"Psi_{k}": LetterForm(rf"\Psi_{{\mathrm {k}}}", f"Ψ_{k}", "eigenvectors of the closed loop") for k in "co"},
    **{
        f"f_{k}": LetterForm(rf"f_{{\mathrm {k}}}", f"f_{k}", "images of the eigenvectors under the gain") for k in "co"
    },
    "O_nu": LetterForm(r"\mathcal O_\nu", "𝒪_ν", "first blocks of the observability matrix"),
    "Ctr_nu": LetterForm(r"\mathcal C_\nu", "𝒞_ν", "first blocks of the controllability matrix"),
    "O_n": LetterForm(r"\mathcal O_n", "𝒪ₙ", "n rows of the observability matrix"),
    "Ctr_n": LetterForm(r"\mathcal C_n", "𝒞ₙ", "n columns of the controllability matrix"),
    **{f"b_{k}": LetterForm(f"b_{k}", f"b{'₀₁₂₃₄₅₆₇₈₉'[k]}", "column of the input matrix") for k in range(1, 10)},
    **{f"c_{k}": LetterForm(f"c_{k}", f"c{'₀₁₂₃₄₅₆₇₈₉'[k]}", "row of the output matrix") for k in range(1, 10)},
    "b_c": LetterForm(r"b_{\mathrm c}", "b_c", "column of the input that is left"),
    "c_o": LetterForm(r"c_{\mathrm o}", "c_o", "row of the output that is left"),
    **{f"A_{side}0": LetterForm(rf"A_{{\mathrm {side}0}}", f"A_{side}₀", "shifted state matrix") for side in "co"},
    "x_1": LetterForm("x_1", "x₁", "measured states"),
    **{f"x_hat_{k}": LetterForm(rf"\hat x_{k}", f"x̂{'₀₁₂'[k]}", "component of the estimate") for k in (1, 2)},
    "x_2": LetterForm("x_2", "x₂", "states that are not measured"),
    "x_2_hat": LetterForm(r"\hat x_2", "x̂₂", "estimate of the states that are not measured"),
    "e_2": LetterForm("e_2", "e₂", "error of the reduced-order observer"),
    "z_o": LetterForm("z", "z", "state of the reduced-order observer"),
    "w_o": LetterForm("w", "w", "state of the reduced-order observer"),
    "c_P": LetterForm("c({v})", "c({v})", "what cancels in the plant's transfer function"),
    "P": LetterForm("P({v})", "P({v})", "plant"),
    "Phi": LetterForm(r"\Phi(t,t_0)", "Φ(t, t₀)", "transition matrix"),
    "Phi_": LetterForm(r"\Phi", "Φ", "transition matrix"),
    "xi": LetterForm(r"\xi", "ξ", "output without the part that the input forces"),
    "x_u": LetterForm("x_u", "x_u", "state that the input alone leads to"),
    "x_t": LetterForm("x(t)", "x(t)", "state as a function of time"),
    "u_t_": LetterForm("u", "u", "input"),
    "y_t_": LetterForm("y", "y", "output"),
    "G_cl": LetterForm(r"G_{\mathrm{cl}}({v})", "G_cl({v})", "closed loop"),
}


_STATES = {"x", "x_1", "x_2", "x_d", "x_hat", "x_hat_1", "x_hat_2", "x_2_hat", "z_o", "w_o", "xi_I", "w_e", "w_hat"}
#: Signals; in discrete time they carry the index k.
SIGNALS = frozenset({*_STATES, "u", "y", "y_hat", "d", "d_hat", "v_r", "e", "e_2", "e_d", "e_w", "r_w", "x_w"})
#: Letters that are functions of several times, and those times; an underscore after the name leaves them out.
TIMED: dict[str, tuple[str, ...]] = {"Phi": ("t", "t0"), "u_t": ("t",), "y_t": ("t",)}
_OF_TIME = {*TIMED, "A", "B", "C", "D", "V", "W", "x_u", "x_t", "C_1", "exp_At", "Y", "x_f", "y_0", "W_t", "V_t"}


def is_of_time(name: str) -> bool:
    """Return whether a letter is no signal but a value that may contain the time: its derivative is d/dt, not a dot."""
    return name in _OF_TIME or name.startswith(("N_", "Phi_"))


def shows_time(name: str) -> bool:
    """Return whether the time is written in a letter: e^{At}, W(t), Aᵏ; its value at an instant stands behind a bar."""
    return name in LETTERS and LETTERS[name].text.endswith(("t)", "k)", "ᵏ"))


FUNCTIONS: dict[str, tuple[str, str]] = {
    "det": (r"\det", "det"),
    "adj": (r"\operatorname{adj}", "adj"),
    "rank": (r"\operatorname{rank}", "rank"),
    **{name: (rf"\{name}", name) for name in ("sin", "cos", "sinh", "cosh")},
    **{f"a{name}": (rf"\arc{name}", f"arc{name}") for name in ("sin", "cos", "tan")},
    "log": (r"\ln", "ln"),
    "sign": (r"\operatorname{sgn}", "sgn"),
    "re": (r"\operatorname{Re}", "Re"),
    "im": (r"\operatorname{Im}", "Im"),
    "mu_at": (r"\mu", "μ"),
    "chi_p_at": (r"\chi", "χ"),
    "chi_cl_at": (r"\chi_{\mathrm{cl}}", "χ_cl"),
    "chi_K_at": (r"\chi_{A-BK}", "χ_(A-BK)"),
    "chi_L_at": (r"\chi_{A-LC}", "χ_(A-LC)"),
    "chi_at": (r"\chi_A", "χ_A"),
    "chi_o_at": (r"\chi_{\mathrm o}", "χ_o"),
    "chi_r_at": (r"\chi_A^*", "χ*_A"),
    "q_s_at": ("q", "q"),
    "n_F_at": ("n_F", "n_F"),
    "d_F_at": ("d_F", "d_F"),
    "phi_at": (r"\varphi", "φ"),
    "phi_c_at": (r"\varphi_{\mathrm c}", "φ_c"),
    "phi_o_at": (r"\varphi_{\mathrm o}", "φ_o"),
    "phi_r_at": (r"\varphi_{\mathrm r}", "φ_r"),
    "b_P_at": ("b", "b"),
}


OPERATORS: dict[str, tuple[str, str]] = {
    "=": ("=", "="),
    "!=": (r"\neq", "≠"),
    "!==": (r"\not\equiv", "≢"),
    "<": ("<", "<"),
    ">": (">", ">"),
    "<=": (r"\le", "≤"),
    ">=": (r"\ge", "≥"),
    "~": (r"\sim", "~"),
    "≈": (r"\approx", "≈"),
}


GREEK = [
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "zeta",
    "eta",
    "theta",
    "iota",
    "kappa",
    "lambda",
    "mu",
    "nu",
    "xi",
    "omicron",
    "pi",
    "rho",
    "sigma",
    "tau",
    "upsilon",
    "phi",
    "chi",
    "psi",
    "omega",
    "Gamma",
    "Delta",
    "Theta",
    "Lambda",
    "Xi",
    "Pi",
    "Sigma",
    "Upsilon",
    "Phi",
    "Psi",
    "Omega",
]


GREEK_LETTERS = dict(zip(GREEK, "αβγδεζηθικλμνξοπρστυφχψωΓΔΘΛΞΠΣΥΦΨΩ", strict=True)) | {"lam": "λ"}
GREEK_LATEX = {name: rf"\{name}" for name in GREEK if name != "omicron"} | {"lam": r"\lambda", "omicron": "o"}
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
#: The rate of a variable, and the rate of that.
_DOTTED = re.compile(r"(.+)_(d?dot)")
_NAME = re.compile(r"^([A-Za-z]+?)_?(\d*)((?:_[A-Za-z0-9]+)*)$")


def symbol_latex(name: str, declared: str | None = None) -> str:
    r"""Return the LaTeX of a parameter's name: `omega_0` → `\omega_{0}`, and `h1` → `h_{1}`."""
    if declared:
        return declared
    dotted = _DOTTED.fullmatch(name)
    stem, digits, rest = _split(dotted[1] if dotted else name)
    head = GREEK_LATEX.get(stem) or (stem if len(stem) == 1 else rf"\mathit{{{stem}}}")
    head = rf"\{dotted[2]}{{{head}}}" if dotted else head
    below = ",".join([digits, *rest] if digits else rest)
    return f"{head}_{{{below}}}" if below else head


_SANS_SERIF = {chr(ord("A") + k): chr(0x1D5A0 + k) for k in range(26)} | {
    chr(ord("a") + k): chr(0x1D5BA + k) for k in range(26)
}


def sans_serif(name: str) -> str:
    r"""Return the LaTeX of a parameter that shares its name with a letter: `L` → `\mathsf{L}`."""
    return rf"\mathsf{{{name}}}"


def symbol_text(name: str, declared: str | None = None) -> str:
    """Return a parameter's name on a terminal: `omega_c` → ω_c, `h1` → h₁; other names stay as they are."""
    if declared == sans_serif(name):
        return "".join(_SANS_SERIF.get(character, character) for character in name)
    if dotted := _DOTTED.fullmatch(name):
        plain = symbol_text(dotted[1])
        return unicodedata.normalize("NFC", plain[0] + ("\u0307" if dotted[2] == "dot" else "\u0308") + plain[1:])
    stem, digits, rest = _split(name)
    if stem not in GREEK_LETTERS and (rest or len(stem) > 1):
        return name
    return "_".join((GREEK_LETTERS.get(stem, stem) + digits.translate(SUBSCRIPTS), *rest))


def printed_alike(letters: Iterable[str], forms: Mapping[str, LetterForm], parameters: Iterable[str]) -> list[str]:
    """Return the parameters that would be printed like one of these letters."""
    printed = {forms[letter].alone.text for letter in letters if letter in forms}
    return sorted(name for name in parameters if symbol_text(name) in printed)


def _split(name: str) -> tuple[str, str, list[str]]:
    match = _NAME.match(name)
    if not match:
        return name.replace("_", ""), "", []
    stem, digits, rest = match.groups()
    return stem, digits, [part for part in rest.split("_") if part]

"""The literature that pages and methods refer to, by short keys; the fields of an entry are those of BibTeX."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.phrases.english.words_phrases import WORDS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

#: Key → kind of publication and its fields, as they are to be printed.
LITERATURE: dict[str, tuple[str, dict[str, str]]] = {}


def _article(key: str, author: str, title: str, journal: str, volume: str, year: str, pages: str) -> None:
    fields = {"author": author, "title": title, "journal": journal, "volume": volume, "year": year, "pages": pages}
    LITERATURE[key] = ("article", fields)


def _book(key: str, author: str, title: str, publisher: str, year: str, edition: str = "") -> None:
    fields = {"author": author, "title": title, "edition": edition, "publisher": publisher, "year": year}
    LITERATURE[key] = ("book", {name: value for name, value in fields.items() if value})


def _proceedings(key: str, author: str, title: str, booktitle: str, year: str, pages: str) -> None:
    fields = {"author": author, "title": title, "booktitle": booktitle, "year": year, "pages": pages}
    LITERATURE[key] = ("inproceedings", fields)


_TAC, _SIAM = "IEEE Trans. Autom. Control", "SIAM J. Control"

_article(
    "ackermann1972",
    "J. Ackermann",
    "Der Entwurf linearer Regelungssysteme im Zustandsraum",
    "Regelungstechnik",
    "20",
    "1972",
    "297–300",
)
_article(
    "baker1905",
    "H. F. Baker",
    "Note on the integration of linear differential equations",
    "Proc. London Math. Soc. (2)",
    "2",
    "1905",
    "293–296",
)
_article(
    "bhattacharyya1982",
    "S. P. Bhattacharyya and E. de Souza",
    "Pole assignment via Sylvester's equation",
    "Syst. Control Lett.",
    "1",
    "1982",
    "261–263",
)
_article(
    "butterworth1930",
    "S. Butterworth",
    "On the theory of filter amplifiers",
    "Experimental Wireless & the Wireless Engineer",
    "7",
    "1930",
    "536–541",
)
_article(
    "davison1976",
    "E. J. Davison",
    "The robust control of a servomechanism problem for linear time-invariant multivariable systems",
    _TAC,
    "21",
    "1976",
    "25–34",
)
_book("ogata2010", "K. Ogata", "Modern Control Engineering", "Prentice Hall", "2010", "5th")
_article(
    "graham1953",
    "D. Graham and R. C. Lathrop",
    "The synthesis of “optimum” transient response: criteria and standard forms",
    "Trans. Amer. Inst. Electr. Eng., Part II",
    "72",
    "1953",
    "273–288",
)
_article(
    "thomson1949",
    "W. E. Thomson",
    "Delay networks having maximally flat frequency characteristics",
    "Proc. Inst. Electr. Eng., Part III",
    "96",
    "1949",
    "487–490",
)
_article(
    "darouach1994",
    "M. Darouach, M. Zasadzinski and S. J. Xu",
    "Full-order observers for linear systems with unknown inputs",
    _TAC,
    "39",
    "1994",
    "606–609",
)
_article("doyle1979", "J. C. Doyle and G. Stein", "Robustness with observers", _TAC, "24", "1979", "607–611")
_article(
    "francis1976",
    "B. A. Francis and W. M. Wonham",
    "The internal model principle of control theory",
    "Automatica",
    "12",
    "1976",
    "457–465",
)
_article(
    "francis1977",
    "B. A. Francis",
    "The linear multivariable regulator problem",
    "SIAM J. Control Optim.",
    "15",
    "1977",
    "486–505",
)
_article(
    "gilbert1963",
    "E. G. Gilbert",
    "Controllability and observability in multivariable control systems",
    _SIAM,
    "1",
    "1963",
    "128–151",
)
_article(
    "johnson1971",
    "C. D. Johnson",
    "Accommodation of external disturbances in linear regulator and servomechanism problems",
    _TAC,
    "16",
    "1971",
    "635–644",
)
_article(
    "gopinath1971",
    "B. Gopinath",
    "On the control of linear multiple input-output systems",
    "Bell Syst. Tech. J.",
    "50",
    "1971",
    "1063–1081",
)
_article(
    "hautus1969",
    "M. L. J. Hautus",
    "Controllability and observability conditions of linear autonomous systems",
    "Proc. Kon. Ned. Akad. Wet. Ser. A",
    "72",
    "1969",
    "443–448",
)
_article(
    "hautus1983",
    "M. L. J. Hautus",
    "Strong detectability and observers",
    "Linear Algebra Appl.",
    "50",
    "1983",
    "353–368",
)
_article(
    "hautus1970",
    "M. L. J. Hautus",
    "Stabilization, controllability and observability of linear autonomous systems",
    "Indag. Math.",
    "32",
    "1970",
    "448–455",
)
_article(
    "hurwitz1895",
    "A. Hurwitz",
    "Ueber die Bedingungen, unter welchen eine Gleichung nur Wurzeln mit negativen reellen Theilen besitzt",
    "Math. Ann.",
    "46",
    "1895",
    "273–284",
)
_article(
    "kalman1962",
    "R. E. Kalman",
    "Canonical structure of linear dynamical systems",
    "Proc. Nat. Acad. Sci. USA",
    "48",
    "1962",
    "596–600",
)
_article(
    "kalman1963",
    "R. E. Kalman",
    "Mathematical description of linear dynamical systems",
    _SIAM,
    "1",
    "1963",
    "152–192",
)
_article(
    "kalman1963a",
    "R. E. Kalman, Y. C. Ho and K. S. Narendra",
    "Controllability of linear dynamical systems",
    "Contrib. Differential Equations",
    "1",
    "1963",
    "189–213",
)
_article(
    "kalman1960a",
    "R. E. Kalman and J. E. Bertram",
    "Control system analysis and design via the second method of Lyapunov, I and II",
    "J. Basic Eng.",
    "82",
    "1960",
    "371–400",
)
_article(
    "kalman1960b",
    "R. E. Kalman",
    "Contributions to the theory of optimal control",
    "Bol. Soc. Mat. Mex.",
    "5",
    "1960",
    "102–119",
)
_article(
    "kucera1972",
    "V. Kučera",
    "A contribution to matrix quadratic equations",
    _TAC,
    "17",
    "1972",
    "344–347",
)
_article(
    "kalman1964",
    "R. E. Kalman",
    "When is a linear control system optimal?",
    "J. Basic Eng.",
    "86",
    "1964",
    "51–60",
)
_article(
    "safonov1977",
    "M. G. Safonov and M. Athans",
    "Gain and phase margin for multiloop LQG regulators",
    _TAC,
    "22",
    "1977",
    "173–179",
)
_article(
    "kalman1961",
    "R. E. Kalman and R. S. Bucy",
    "New results in linear filtering and prediction theory",
    "J. Basic Eng.",
    "83",
    "1961",
    "95–108",
)
_article("leonard1996", "I. E. Leonard", "The matrix exponential", "SIAM Review", "38", "1996", "507–512")
_article(
    "lienard1914",
    "A. Liénard and M. H. Chipart",
    "Sur le signe de la partie réelle des racines d'une équation algébrique",
    "J. Math. Pures Appl. (6)",
    "10",
    "1914",
    "291–346",
)
_article(
    "luenberger1964",
    "D. G. Luenberger",
    "Observing the state of a linear system",
    "IEEE Trans. Mil. Electron.",
    "8",
    "1964",
    "74–80",
)
_article("luenberger1966", "D. G. Luenberger", "Observers for multivariable systems", _TAC, "11", "1966", "190–197")
_article(
    "luenberger1967",
    "D. G. Luenberger",
    "Canonical forms for linear multivariable systems",
    _TAC,
    "12",
    "1967",
    "290–293",
)
_article("luenberger1971", "D. G. Luenberger", "An introduction to observers", _TAC, "16", "1971", "596–602")
_article(
    "moore1976",
    "B. C. Moore",
    "On the flexibility offered by state feedback in multivariable systems beyond closed loop eigenvalue assignment",
    _TAC,
    "21",
    "1976",
    "689–692",
)
_article(
    "orlando1911",
    "L. Orlando",
    "Sul problema di Hurwitz relativo alle parti reali delle radici di un'equazione algebrica",
    "Math. Ann.",
    "71",
    "1911",
    "233–245",
)
_article(
    "peano1888",
    "G. Peano",
    "Intégration par séries des équations différentielles linéaires",
    "Math. Ann.",
    "32",
    "1888",
    "450–456",
)
_article(
    "silverman1967",
    "L. M. Silverman and H. E. Meadows",
    "Controllability and observability in time-variable linear systems",
    _SIAM,
    "5",
    "1967",
    "64–73",
)
_article(
    "sturm1829",
    "C. Sturm",
    "Mémoire sur la résolution des équations numériques",
    "Bull. Sci. Férussac",
    "11",
    "1829",
    "419–425",
)
_article(
    "wonham1967",
    "W. M. Wonham",
    "On pole assignment in multi-input controllable linear systems",
    _TAC,
    "12",
    "1967",
    "660–665",
)
_article(
    "wonham1968",
    "W. M. Wonham",
    "On a matrix Riccati equation of stochastic control",
    _SIAM,
    "6",
    "1968",
    "681–697",
)
_article(
    "youla1974",
    "D. C. Youla, J. J. Bongiorno and C. N. Lu",
    "Single-loop feedback-stabilization of linear multivariable dynamical plants",
    "Automatica",
    "10",
    "1974",
    "159–173",
)
_book("belevitch1968", "V. Belevitch", "Classical Network Theory", "Holden-Day", "1968")
_book("brockett1970", "R. W. Brockett", "Finite Dimensional Linear Systems", "Wiley", "1970")
_book("brogan1991", "W. L. Brogan", "Modern Control Theory", "Prentice Hall", "1991", "3rd")
_book(
    "anderson1990",
    "B. D. O. Anderson and J. B. Moore",
    "Optimal Control: Linear Quadratic Methods",
    "Prentice Hall",
    "1990",
)
_book("chen1999", "C.-T. Chen", "Linear System Theory and Design", "Oxford University Press", "1999", "3rd")
_book("jury1964", "E. I. Jury", "Theory and Application of the z-Transform Method", "Wiley", "1964")
_book("astrom1997", "K. J. Åström and B. Wittenmark", "Computer-Controlled Systems", "Prentice Hall", "1997", "3rd")
_book("lancaster1985", "P. Lancaster and M. Tismenetsky", "The Theory of Matrices", "Academic Press", "1985", "2nd")
_book(
    "trentelman2001",
    "H. L. Trentelman, A. A. Stoorvogel and M. Hautus",
    "Control Theory for Linear Systems",
    "Springer",
    "2001",
)
_book("kailath1980", "T. Kailath", "Linear Systems", "Prentice Hall", "1980")
_book("popov1973", "V. M. Popov", "Hyperstability of Control Systems", "Springer", "1973")
_book(
    "skogestad2005",
    "S. Skogestad and I. Postlethwaite",
    "Multivariable Feedback Control",
    "Wiley",
    "2005",
    "2nd",
)
_book("routh1877", "E. J. Routh", "A Treatise on the Stability of a Given State of Motion", "Macmillan", "1877")
_book("rugh1996", "W. J. Rugh", "Linear System Theory", "Prentice Hall", "1996", "2nd")
_proceedings(
    "bass1965",
    "R. W. Bass and I. Gura",
    "High order system design via state-space considerations",
    "Preprints Joint Automatic Control Conf., Troy, NY",
    "1965",
    "",
)
_proceedings(
    "collins1975",
    "G. E. Collins",
    "Quantifier elimination for real closed fields by cylindrical algebraic decomposition",
    "Lecture Notes in Computer Science 33, Springer",
    "1975",
    "134–183",
)
_proceedings(
    "kalman1960",
    "R. E. Kalman",
    "On the general theory of control systems",
    "Proc. 1st IFAC Congress, Moscow, vol. 1",
    "1960",
    "481–492",
)


def cited(references: str) -> list[tuple[str, str]]:
    """Return the keys and places in a text such as "kalman1963; kailath1980, ch. 2"."""
    parts = [part.partition(",") for part in references.split(";")]
    return [(key.strip(), place.strip()) for key, _, place in parts]


def written_out(references: str) -> str:
    """Return the references of such a text in full, with the places in them; what is no key stays as it is."""
    return "; ".join(f"{reference(key)}{', ' * bool(place)}{place}" for key, place in cited(references))


def short_reference(key: str, words: Mapping[str, str] = WORDS) -> str:
    """Return authors, year and place of one entry, on one line; of a book the title."""
    if key not in LITERATURE:
        return key
    _, of = LITERATURE[key]
    authors = " ".join(part for part in of["author"].split() if not part.rstrip(",").endswith("."))
    pages = f", {of['pages']}" if of.get("pages") else ""
    volume = f" {of['volume']}" if of.get("volume") else ""
    place = of.get("journal") or of.get("booktitle") or of["title"]
    return f"{authors.replace(' and ', words['authors'])} ({of['year']}), {place}{volume}{pages}"


def reference(key: str, words: Mapping[str, str] = WORDS) -> str:
    """Return one entry in standard form, with the words of a language; what is no key is returned."""
    if key not in LITERATURE:
        return key
    kind, of = LITERATURE[key]
    author = of["author"].replace(" and ", words["authors"])
    pages = f", {of['pages']}" if of.get("pages") else ""
    if kind == "article":
        return f"{author}, {of['title']}, {of['journal']} {of['volume']} ({of['year']}){pages}"
    if kind == "book":
        ordinal = of.get("edition", "")
        edition = words["edition"].format(ordinal=ordinal, number=ordinal.rstrip("dhnrst")) + ", " if ordinal else ""
        return f"{author}, {of['title']}, {edition}{of['publisher']}, {of['year']}"
    return f"{author}, {of['title']}, in: {of['booktitle']}, {of['year']}{pages}"


def bibliography(keys: Iterable[str]) -> str:
    """Return entries as a BibTeX file; what is no key of the literature has none."""
    entries = []
    for key in sorted({key for key in keys if key in LITERATURE}):
        kind, of = LITERATURE[key]
        fields = {name: value.replace("–", "--").replace("&", r"\&") for name, value in of.items() if value}
        fields["author"] = fields["author"].replace(", ", " and ")
        fields["title"] = f"{{{fields['title']}}}"
        lines = "".join(f"  {name} = {{{value}}},\n" for name, value in fields.items())
        entries.append(f"@{kind}{{{key},\n{lines}}}\n")
    return "\n".join(entries)


const words = document.getElementById("words").dataset;
for (const box of document.querySelectorAll("[data-latex]")) {
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: words.copy });
  button.addEventListener("click", async () => {
    button.textContent = await navigator.clipboard.writeText(box.dataset.latex).then(() => words.copied, () => words.refused);
    setTimeout(() => { button.textContent = words.copy; }, 1500);
  });
  box.append(button);
}

/* Marks the answers on a sheet as `rolling_ellipse.course.mark` does, with the key in the page. */

/** The bytes that a base64 text encodes. */
function bytes(text) {
    return Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
}

/** The key of a page: for each task, the numbers at which the mark changes, and all its marks. */
function unhidden([salted, mixed]) {
    const salt = bytes(salted);
    const plain = bytes(mixed).map((byte, place) => byte ^ salt[place % salt.length]);
    return JSON.parse(new TextDecoder().decode(plain));
}

/** The mark of an answer, [points, sentence, mistake], or null if the text is not a number. */
function markOf(key, task, text) {
    const word = text.trim().replace("\u2212", "-");
    if (!new RegExp(`^(?:${key.number})$`).test(word)) return null;
    const given = Number(word.replace(",", "."));
    if (!Number.isFinite(given)) return null;
    const { ends, which, marks } = key.tasks[task];
    return marks[which[ends.filter(end => end <= given).length]];
}

/** Show the marks now and after every change of a field. */
function start(key) {
    const total = document.querySelector("#points");
    const fields = [...document.querySelectorAll("[data-task]")];
    const tell = () => {
        let sum = 0;
        for (const field of fields) {
            const mark = field.value.trim() && markOf(key, field.dataset.task, field.value);
            const [points, sentence] = mark || [0, mark === null ? "This is not a number." : ""];
            const shown = field.closest("label").querySelector("output");
            shown.textContent = mark ? `${points} point${points === 1 ? "" : "s"}. ${sentence}` : sentence;
            sum += points;
        }
        total.textContent = `${sum} of 10 points`;
    };
    for (const field of fields) field.addEventListener("change", tell);
    tell();
}

const key = unhidden(JSON.parse(document.querySelector("#key").textContent));
start(key);

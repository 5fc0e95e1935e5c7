// Each entry of INDEX: page, title of the page, title of the section, anchor, text.
const MOST_SHOWN = 20;
const AROUND = 60;

function score(entry, words) {
  const [, page, title, , text] = entry.map(part => part.toLowerCase());
  let sum = 0;
  for (const word of words) {
    const found = 8 * title.includes(word) + 4 * page.includes(word) + text.includes(word);
    if (!found) { return 0; }
    sum += found;
  }
  return sum;
}

function search(query) {
  const words = query.toLowerCase().split(/\s+/).filter(Boolean);
  if (!words.length) { return []; }
  return INDEX.map(entry => ({ entry, score: score(entry, words) }))
    .filter(found => found.score > 0)
    .sort((one, other) => other.score - one.score)
    .slice(0, MOST_SHOWN)
    .map(found => ({ entry: found.entry, excerpt: excerpt(found.entry[4], words) }));
}

function excerpt(text, words) {
  const places = words.map(word => text.toLowerCase().indexOf(word)).filter(place => place >= 0);
  const start = Math.max(0, Math.min(...(places.length ? places : [0])) - AROUND);
  return (start ? "… " : "") + text.slice(start, start + 3 * AROUND);
}

function show(query) {
  const list = document.getElementById("found");
  list.replaceChildren(...search(query).map(({ entry, excerpt }) => {
    const [file, page, title, anchor] = entry;
    const item = document.createElement("li"), link = document.createElement("a");
    const words = document.createElement("p");
    link.href = document.body.dataset.up + file + "#" + anchor;
    link.textContent = page === title ? title : page + ": " + title;
    words.textContent = excerpt;
    item.append(link, words);
    return item;
  }));
}

if (typeof document !== "undefined") {
  document.getElementById("search").addEventListener("input", event => show(event.target.value));
}

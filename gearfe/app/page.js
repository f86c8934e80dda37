"use strict";
// The page of `gearfe app`: a form made from the server's table of fields, questions to the solvers of which the newest wins, and
// pictures of their answers. Every number that is printed comes formatted from gearfe, curves as they were solved.
const $ = (id) => document.getElementById(id), all = (query) => [...document.querySelectorAll(query)];
const page = crypto.getRandomValues(new Uint32Array(2)).join("-"), REST = 250, SAME = 800;  // ms
let fields = [], kinds = {}, start = {}, state = {}, past = [], changed = { at: 0, name: "" }, shown = null, pinned = null, expected = {};
let busy = false, again = false, version = 0, timer = 0, restful = null, slow = null;

// --- asking ---
async function ask(kind, body, { signal, tell = () => {} } = {}) {
  const text = JSON.stringify({ page, ...body });
  let answer = { refused: "The server does not answer: is gearfe app still running?" };
  try {
    const response = await fetch(`task/${kind}`, { method: "POST", body: text, signal });
    const reader = response.body.pipeThrough(new TextDecoderStream()).getReader();
    let rest = "";
    for (let part; !(part = await reader.read()).done;) {
      const lines = (rest + part.value).split("\n");
      rest = lines.pop();
      for (const line of lines.filter(Boolean)) {
        answer = JSON.parse(line);
        if ("waiting" in answer || "expected" in answer) { tell(answer); answer = { stale: true }; }
      }
    }
    if (rest) answer = JSON.parse(rest);  // a refusal is one text
  } catch (error) {
    if (error.name === "AbortError") return { stale: true };
  }
  return answer;
}
const words = (known) => "waiting" in known ? `All solvers are at work: ${known.waiting} before you.` : `About ${Math.ceil(known.expected)} s.`;

function say(text, refused = false) {
  $("said").textContent = text;
  $("said").classList.toggle("refused", refused);
}

// Quick pictures while something moves, one question at a time; the fine one when the hand rests.
async function solve() {
  version += 1;
  clearTimeout(timer);
  restful?.abort();
  document.body.classList.add("dim");
  all("#stress, #spectrum").forEach((one) => one.classList.add("old"));
  if (busy) { again = true; return; }
  busy = true;
  do {
    again = false;
    take(await ask("quick", { state }, { tell: (known) => say(words(known)) }), !again);
  } while (again);
  busy = false;
  timer = setTimeout(rest, REST);
}

async function rest() {
  const own = version;
  restful = new AbortController();
  history.replaceState(null, "", link());
  const answer = await ask("fine", { state }, { signal: restful.signal });
  if (own === version && !answer.stale) { take(answer, true); $("spoken").textContent = answer.headline ?? answer.refused; }
  if (own !== version || answer.stale || answer.refused) return;
  if (!$("program").hidden) showProgram(await ask("python", { state }));
  if (answer.section) demand("solid");
}

function showProgram(answer) {
  $("program").querySelector("pre").textContent = answer.text ?? answer.refused ?? "";
}

function take(answer, last) {
  if (answer.stale) return;
  if (answer.refused) {
    if (last) say(answer.refused, true);
    return;
  }
  const first = !shown;
  shown = answer;
  if (first) fill(document.activeElement?.id);  // ranges of the sliders of damage
  if (last) { document.body.classList.remove("dim"); say(`${answer.method}; ${answer.picture.told}`); }
  draw();
}

// --- the form ---
function build() {
  const groups = new Map();
  for (const field of fields) {
    if (!groups.has(field.group)) groups.set(field.group, []);
    groups.get(field.group).push(field);
  }
  for (const [name, own] of groups) {
    const box = Object.assign(document.createElement("details"), { open: ["Pair", "Load", "Damage"].includes(name) });
    box.append(Object.assign(document.createElement("summary"), { textContent: name }), ...own.map(row));
    if (name === "Load") box.append(torque());
    if (name === "Damage") box.querySelector("summary").after(Object.assign(document.createElement("div"), { id: "damage" }), more());
    $("form").append(box);
  }
  $("form").addEventListener("submit", (event) => event.preventDefault());
}

// --- damage: a box for each row, with a field for each key of its kind; an empty field is a key that is left out ---
const damaged = (i, name) => ({ name: `damage_${i}_${name}`, at: [i, name] });
const own = (i) => kinds[state.damage[i].kind].map((field) => (
  { ...field, ...damaged(i, field.key), when: "", start: shown?.first[state.damage[i].kind][field.key] ?? 0 }));
const every = () => [...fields, ...state.damage.flatMap((_, i) => own(i))];

function more() {
  const label = Object.assign(document.createElement("label"), { htmlFor: "add", textContent: "add damage" }), input = document.createElement("select");
  input.id = "add";
  input.append(...["", ...Object.keys(kinds)].map((one) => new Option(one.replace("_", " "), one)));
  input.addEventListener("change", () => {
    const fresh = shown?.first[input.value];
    input.value = "";
    if (fresh) become({ ...state, damage: [...state.damage, fresh] });
    else say("First enter gears that can be solved.", true);
  });
  const box = Object.assign(document.createElement("div"), { className: "field" });
  box.append(label, input);
  return box;
}

function boxes() {
  const made = state.damage.map((row_, i) => {
    const box = Object.assign(document.createElement("details"), { open: i === state.damage.length - 1 || $(`damage_${i}`)?.open, id: `damage_${i}` });
    const rest = document.createElement("details"), mine = own(i), other = mine.filter((field) => !field.first).map(row);
    const gone = Object.assign(document.createElement("button"), { type: "button", textContent: "Remove", id: `remove_${i}` });
    gone.addEventListener("click", () => become({ ...state, damage: state.damage.filter((_, k) => k !== i) }));
    rest.append(Object.assign(document.createElement("summary"), { textContent: "Further values" }), ...other);
    rest.open = Boolean(mine.find((field) => !field.first && row_[field.key] !== undefined));
    box.append(document.createElement("summary"), ...mine.filter((field) => field.first).map(row), ...(other.length ? [rest] : []), gone);
    return box;
  });
  $("damage").replaceChildren(...made);
  $("damage").dataset.kinds = state.damage.map((one) => one.kind);
}

// A typed text as the value of a key; undefined: left out.
function typedValue(field, input) {
  if (field.truth) return input.value === "yes";
  if (field.list) return input.value.trim() ? input.value.trim().split(/[\s,;]+/).map(Number) : undefined;
  if (field.choices.length) return input.value;
  return Number.isNaN(input.valueAsNumber) && field.at ? undefined : input.valueAsNumber;
}

function row(field) {
  const box = Object.assign(document.createElement("div"), { className: "field" });
  const label = Object.assign(document.createElement("label"), { htmlFor: field.name, textContent: field.label });
  Object.assign(box.dataset, { when: field.when, field: field.name });
  let input;
  if (field.choices.length) {
    input = document.createElement("select");
    input.append(...field.choices.map((one) => new Option(one, one)));
    box.append(label, input);
  } else {
    input = Object.assign(document.createElement("input"), { type: field.list ? "text" : "number", step: field.whole ? 1 : "any" });
    if (field.low !== null && !field.list) Object.assign(input, { min: field.low, max: field.high });
    if (field.unused) Object.assign(input, { placeholder: field.unused, title: `left out: ${field.unused}` });
    const unit = Object.assign(document.createElement("span"), { className: "unit", textContent: field.unit });
    box.append(label, input, unit);
    if (!field.list && field.low !== null && (field.start || field.at || field.high <= 500)) {
      const slider = Object.assign(document.createElement("input"), { type: "range", id: `${field.name}_slider` });
      slider.setAttribute("aria-label", `${field.label} ${field.unit}, slider`);
      slider.addEventListener("input", () => change(field, slider.valueAsNumber));
      box.append(slider);
    }
    input.setAttribute("aria-label", `${field.label} ${field.unit}`);
  }
  input.id = field.name;
  input.addEventListener("input", () => change(field, typedValue(field, input), true));
  return box;
}

function torque() {  // another way to give the force: over the pinion's base radius
  const own = row({ name: "torque", label: "or torque on the pinion", unit: "N m", choices: [], when: "", low: 0, high: 1e9, start: 0 });
  const input = own.querySelector("input"), fresh = input.cloneNode();
  input.replaceWith(fresh);
  fresh.addEventListener("change", () => {
    if (fresh.valueAsNumber > 0 && shown) change({ name: "force" }, Number((1e3 * fresh.valueAsNumber / shown.picture.r_b).toPrecision(6)));
  });
  return own;
}

function change(field, value, typed = false) {
  const now = performance.now();
  if (changed.name !== field.name || now - changed.at > SAME) remember();
  changed = { at: now, name: field.name };
  if (field.at) {
    const [i, key] = field.at, without = value === undefined ? {} : Object.fromEntries(field.excludes.map((one) => [one, undefined]));
    state = { ...state, damage: state.damage.map((one, k) => (k === i ? { ...one, ...without, [key]: value } : one)) };
  } else state = { ...state, [field.name]: value };
  fill(typed ? field.name : "");
  solve();
}

function remember() {
  past = [...past.slice(-99), state];
  $("undo").disabled = false;
}

function become(next) {  // a whole other state
  remember();
  changed = { at: 0, name: "" };
  state = next;
  fill();
  solve();
}

// Values into the form; not into the field somebody types in.
function fill(typed = "") {
  if ($("damage").dataset.kinds !== String(state.damage.map((one) => one.kind))) boxes();
  for (const [i, one] of state.damage.entries()) {
    const size = ["length_mm", "level", "depth_mm"].filter((key) => one[key] !== undefined).map((key) => `, ${one[key]}${key === "level" ? "" : " mm"}`);
    $(`damage_${i}`).querySelector("summary").textContent = `${one.kind.replace("_", " ")}: tooth ${one.tooth ?? 0} of the ${one.gear}${size[0] ?? ""}`;
  }
  for (const field of every()) {
    const input = $(field.name), value = field.at ? state.damage[field.at[0]][field.key] : state[field.name], slider = $(`${field.name}_slider`);
    const text = value ?? (field.choices.length && field.at ? field.unused.replaceAll("'", "") : "");
    if (field.name !== typed) input.value = field.list ? (value ?? []).join(", ") : field.truth ? ["no", "yes"][Number(value ?? 0)] : text;
    const wrong = !field.choices.length && !field.list && !(value >= (field.low ?? -Infinity) && value <= (field.high ?? Infinity));
    input.setAttribute("aria-invalid", wrong && !(field.at && value === undefined));
    if (slider) slider.hidden = Boolean(field.at) && value === undefined;
    if (slider && Number.isFinite(value)) {
      const far = field.start > 0 && field.high > 6 * field.start;
      slider.min = Math.min(far ? Math.max(field.low, field.start / 10) : field.low, value);
      slider.max = Math.max(far ? 4 * field.start : field.high, value);
      slider.step = Number.isInteger(Math.round((value - slider.min) / field.step * 1e6) / 1e6) ? field.step : "any";
      slider.value = value;
    }
  }
  const hidden = new Set();
  for (const box of all(".field")) {
    const [name, values] = (box.dataset.when || "").split("=");
    box.hidden = Boolean(name) && (hidden.has(name) || !values.split(",").includes(state[name]));
    if (box.hidden) hidden.add(box.dataset.field);
  }
}

// --- link, files ---
function link() {
  const own = new URLSearchParams();
  for (const [name, value] of Object.entries(state)) {
    if (JSON.stringify(value) !== JSON.stringify(start[name])) own.set(name, typeof value === "string" ? value : JSON.stringify(value));
  }
  return `#${own}`;
}

function linked() {
  const out = { ...start };
  for (const [name, text] of new URLSearchParams(location.hash.slice(1))) {
    try {
      out[name] = typeof start[name] === "string" ? text : JSON.parse(text);
    } catch { out[name] = text; }  // the server says what is wrong with it
  }
  return out;
}

function save(name, blob) {
  const anchor = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: name });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(anchor.href), 1e4);
}

async function carry(kind) {
  const answer = await ask(kind, { state }, { tell: (known) => say(words(known)) });
  if (answer.stale) return;
  if (answer.refused) { say(answer.refused, true); return; }
  if (kind === "python") {
    $("program").hidden = false;
    $("program").open = true;
    showProgram(answer);
    $("program").scrollIntoView({ block: "nearest" });
  } else save(answer.file, new Blob([answer.text], { type: answer.kind }));
  say(kind === "python" ? "The program stands below." : `${answer.file} is in your downloads.`);
}

async function load(given) {
  const answer = await ask("load", given);
  $("choose").hidden = true;
  if (answer.refused) say(answer.refused, true);
  if (answer.choices) choose(given, answer.choices);
  if (!answer.state) return;
  become(answer.state);
  if (answer.notes.length) $("choose").replaceChildren(...answer.notes.map((one) => Object.assign(document.createElement("p"), { textContent: one })));
  $("choose").hidden = !answer.notes.length;
}

function choose(given, choices) {
  const buttons = Object.entries(choices).flatMap(([pair, cases]) => cases.map((one) => {
    const button = Object.assign(document.createElement("button"), { textContent: `${pair}, ${one || "healthy"}` });
    button.addEventListener("click", () => load({ ...given, pair, case: one }));
    return button;
  }));
  $("choose").replaceChildren(...buttons);
  $("choose").hidden = false;
  buttons[0].focus();
}

// --- pictures ---
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const KINDS = { healthy: ["c0", "solid"], cracked: ["c1", "dash"], pitted: ["c1", "dash"], damaged: ["c1", "dash"] };
const DASHES = ["solid", "dash", "dot", "dashdot", "longdash", "longdashdot"];

function draw() {
  $("headline").textContent = shown.headline;
  $("named").textContent = shown.named;
  $("definition").textContent = shown.definition;
  const rows = shown.tables.flatMap(([words, cells]) => {
    const title = Object.assign(document.createElement("th"), { textContent: words, colSpan: cells[0].length }), line = document.createElement("tr");
    line.append(title);
    return [...(shown.tables.length > 1 ? [line] : []), ...cells.map((one, at) => {
      const next = document.createElement("tr");
      next.append(...one.map((text) => Object.assign(document.createElement(at ? "td" : "th"), { textContent: text })));
      return next;
    })];
  });
  $("zones").replaceChildren(...rows);
  const lines = [...shown.notes, ...shown.assumed.map((one) => `assumed: ${one}`), "assumed: plane strain, lubricant and friction left out, bores held"];
  $("notes").replaceChildren(...lines.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  if (document.activeElement !== $("torque")) $("torque").value = (state.force * shown.picture.r_b / 1e3).toPrecision(5);
  const phases = shown.curves[0].at, range = $("phase");
  const [old, low, high] = [range.valueAsNumber, Math.min(...phases), Math.max(...phases)];
  [range.min, range.max] = [low, high];
  if (!(old >= low && old <= high)) range.value = shown.middle;
  drawMesh();
  drawCurves();
}

function look(extra = {}) {
  const grid = { gridcolor: colour("line"), zerolinecolor: colour("line"), linecolor: colour("line") };
  return { font: { color: colour("ink"), size: 12, family: "system-ui, sans-serif" }, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
    margin: { l: 66, r: 8, t: 8, b: 40 }, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, hovermode: "x", grid, ...extra };
}

const OPTIONS = { responsive: true, displaylogo: false, displayModeBar: false };
const faint = (hex) => `${hex}38`;

function traces() {
  const out = [], { curves, share } = shown;
  const old = pinned ? pinned.curves.map((one) => [one, "pin", "dot", `pinned, ${one.name}`]) : [];
  for (const [one, tint, dash, name] of [...old, ...curves.map((one) => [one, ...(KINDS[one.name] ?? KINDS.damaged), one.name])]) {
    const line = { color: colour(tint), dash, width: tint === "pin" ? 1.5 : 2.2 };
    if (one.error.length && tint !== "pin") {
      const sides = [1, -1].map((sign) => one.solved.map((k, i) => k / 1e6 + sign * one.error[i]));
      out.push({ x: [...one.at, ...one.at.toReversed()], y: [...sides[0], ...sides[1].toReversed()], fill: "toself", fillcolor: faint(colour(tint)),
        line: { width: 0 }, hoverinfo: "skip", name: `error of ${name}`, showlegend: false });
    }
    out.push({ x: one.phase, y: one.k, name, line, hovertemplate: "%{y:.4g} N/µm" });
    out.push({ x: one.at, y: one.te, yaxis: "y2", line, showlegend: false, name, hovertemplate: "%{y:.4g} µm" });
  }
  share.order.forEach((order, i) => {
    if (share.value[i].some(Boolean)) {
      out.push({ x: share.phase, y: share.value[i], yaxis: "y3", showlegend: false, name: `pair ${order}`, hovertemplate: "%{y:.3f}",
        line: { color: colour(`c${((order % 4) + 4) % 4}`), dash: DASHES[((order % 6) + 6) % 6], width: 1.8 } });
    }
  });
  return out;
}

// Phases with one number of tooth pairs in contact: those with the fewest are shaded, every number is printed.
function bands() {
  const { phase, value } = shown.share, count = phase.map((_, i) => value.filter((one) => one[i]).length), shapes = [], annotations = [];
  for (let first = 0, i = 1; i <= phase.length; i += 1) {
    if (i < phase.length && count[i] === count[first]) continue;
    const edge = (k) => (phase[Math.max(k - 1, 0)] + phase[Math.min(k, phase.length - 1)]) / 2, [x0, x1] = [edge(first), edge(i)];
    if (count[first] === Math.min(...count)) shapes.push({ type: "rect", x0, x1, y0: 0, y1: 1, yref: "paper", fillcolor: faint(colour("pin")), line: { width: 0 }, layer: "below" });
    if (x1 - x0 > 0.1) annotations.push({ x: (x0 + x1) / 2, y: 0.24, yref: "paper", showarrow: false, font: { size: 10 }, text: `${count[first]} pair${count[first] > 1 ? "s" : ""}` });
    first = i;
  }
  return { shapes, annotations };
}

function drawCurves() {
  const { grid, ...plain } = look();
  const axis = (title, low, high, more = {}) => ({ ...grid, title: { text: title, standoff: 4 }, domain: [low, high], ...more });
  const layout = { ...plain, ...bands(), xaxis: { ...grid, title: { text: "mesh phase" }, anchor: "y3" },
    yaxis: axis("k [N/µm]", 0.52, 1), yaxis2: axis("trans. error<br>[µm]", 0.27, 0.47), yaxis3: axis("load share", 0, 0.22, { range: [0, 1.05] }) };
  const fresh = !$("curves").data;
  Plotly.react($("curves"), traces(), layout, OPTIONS);
  if (fresh) $("curves").on("plotly_hover", (event) => turn(event.points[0].x));
}

const SVG = "http://www.w3.org/2000/svg";
function element(name, given, inside = []) {
  const out = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(given)) out.setAttribute(key, value);
  out.append(...inside);
  return out;
}
const path = (points) => "M" + points.map((one) => one.map((v) => v.toFixed(4)).join(",")).join("L");

function drawMesh() {
  const own = shown.picture, wide = 1.15 * own.half, thin = own.half / 260;
  const gears = own.gears.map((gear, i) => {
    const teeth = [];
    for (let k = 0; k < gear.z; k += 1) {
      const [s, c] = [Math.sin(2 * Math.PI * k / gear.z), Math.cos(2 * Math.PI * k / gear.z)];
      for (const [x, y] of gear.tooth) teeth.push([x * c + y * s, y * c - x * s]);
    }
    const r = gear.held, hole = `M${r},0A${r},${r} 0 1 0 ${-r},0A${r},${r} 0 1 0 ${r},0Z`;
    const marks = gear.damage.map((one) => element("path", { d: path(one.line), fill: "none", stroke: colour("c1"), "stroke-width": 5 * thin, "stroke-linecap": "round" }));
    const body = element("path", { d: `${path(teeth)}Z${hole}`, fill: colour(`g${i}`), stroke: colour("edge"), "stroke-width": 1.6 * thin, "fill-rule": "evenodd" });
    return element("g", { "data-gear": i }, [body, ...marks]);
  });
  const at = (along) => [along * Math.cos(own.alpha), own.pitch + along * Math.sin(own.alpha)];
  const line = element("path", { d: path(own.path.map(at)), stroke: colour("ink"), "stroke-width": 2 * thin, "stroke-dasharray": `${8 * thin} ${6 * thin}` });
  const dots = element("g", { id: "dots" });
  $("mesh").setAttribute("viewBox", `${-wide} ${-own.pitch - own.half} ${2 * wide} ${2 * own.half}`);
  $("mesh").replaceChildren(element("g", { transform: "scale(1,-1)" }, [...gears, line, dots]));
  const hurt = own.gears.flatMap((gear, i) => gear.damage.map((one) => `${one.kind} in the ${["pinion", "wheel"][i]}`));
  $("mesh").setAttribute("aria-label", `teeth in mesh, to scale: ${hurt.join(", ") || "healthy"}; ${own.told}`);
  $("told").textContent = "Transverse section, to scale. Dots: contacts, as large as their share of the load. Move over k to turn the gears.";
  turn(Number($("phase").value));
}

function turn(phase) {
  const own = shown.picture, { share } = shown, thin = own.half / 260;
  $("phase").value = phase;
  $("at").textContent = phase.toFixed(2);
  for (const group of all("[data-gear]")) {
    const gear = own.gears[group.dataset.gear], degrees = -(gear.turn + gear.rate * phase) * 180 / Math.PI;
    group.setAttribute("transform", `translate(0,${gear.centre}) rotate(${degrees}) scale(${gear.mirror},1)`);
  }
  const near = share.phase.reduce((best, one, i) => (Math.abs(one - phase) < Math.abs(share.phase[best] - phase) ? i : best), 0);
  $("dots").replaceChildren(...share.order.flatMap((order, i) => {
    const part = share.value[i][near], along = own.path[0] + (phase + order) * own.p_bt;
    return part ? [element("circle", { cx: along * Math.cos(own.alpha), cy: own.pitch + along * Math.sin(own.alpha),
      r: (4 + 9 * Math.sqrt(part)) * thin, fill: colour("c2"), stroke: colour("paper"), "stroke-width": thin })] : [];
  }));
}

async function png() {
  const scale = 2, [wide, tall, side] = [1100, 620, 460], canvas = Object.assign(document.createElement("canvas"), { width: scale * wide, height: scale * tall });
  const own = canvas.getContext("2d"), copy = $("mesh").cloneNode(true);
  copy.setAttribute("width", scale * side);
  copy.setAttribute("height", scale * side / 1.15);
  const image = async (address) => { const one = new Image(); one.src = address; await one.decode(); return one; };
  const curves = await image(await Plotly.toImage($("curves"), { format: "png", width: wide - side, height: tall - 50, scale }));
  const mesh = await image(`data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`);
  own.fillStyle = colour("paper");
  own.fillRect(0, 0, canvas.width, canvas.height);
  own.drawImage(mesh, 0, 100 * scale);
  own.drawImage(curves, side * scale, 50 * scale);
  own.fillStyle = colour("ink");
  own.font = `${15 * scale}px system-ui, sans-serif`;
  own.fillText(shown.headline, 14 * scale, 30 * scale, (wide - 28) * scale);
  canvas.toBlob((blob) => save("gear.png", blob));
}

// --- on demand ---
async function demand(kind) {
  slow?.abort();
  slow = new AbortController();
  const own = version;
  $("slow").textContent = `About ${Math.ceil(expected[kind])} s.`;
  const answer = await ask(kind, { state }, { signal: slow.signal, tell: (known) => { expected[kind] = known.expected ?? expected[kind]; $("slow").textContent = words(known); } });
  if (answer.stale) return;
  $("slow").textContent = answer.refused ?? (own === version ? "" : "Of an earlier state: the gears were changed meanwhile.");
  if (answer.refused) return;
  if (kind === "solid") { if (own === version) { clearTimeout(timer); restful?.abort(); take(answer, true); } return; }
  const figure = $(kind);
  figure.hidden = false;
  figure.classList.toggle("old", own !== version);
  figure.querySelector("figcaption").textContent = [answer.text, ...answer.notes].join(". ");
  if (kind === "stress") {
    Object.assign(figure.querySelector("img"), { src: `data:image/png;base64,${answer.png}`, alt: answer.text });
  } else drawSpectrum(figure.querySelector("div"), answer);
}

function drawSpectrum(place, { spectra, lines, title }) {
  const { grid, ...plain } = look({ hovermode: "closest", margin: { l: 62, r: 8, t: 100, b: 40 } });
  const data = spectra.map((one, i) => ({ x: one.f, y: one.value, name: one.name, line: { width: 1.2, color: colour(`c${i}`), dash: DASHES[i] } }));
  const shapes = lines.map((one) => ({ type: "line", x0: one.f, x1: one.f, y0: 0, y1: 1, yref: "paper", line: { color: colour("pin"), dash: "dot", width: 1 } }));
  const annotations = lines.map((one) => ({ x: one.f, y: 1, yref: "paper", text: one.name, textangle: -90, yanchor: "bottom", showarrow: false, font: { size: 10 } }));
  const legend = { orientation: "h", y: -0.15 };
  Plotly.react(place, data, { ...plain, legend, shapes, annotations, xaxis: { ...grid, title: { text: "frequency [Hz]" } },
    yaxis: { ...grid, type: "log", exponentformat: "power", title: { text: title } } }, OPTIONS);
}

// --- buttons, keys ---
function undo() {
  if (!past.length) return;
  state = past.pop();
  $("undo").disabled = !past.length;
  changed = { at: 0, name: "" };
  fill();
  solve();
}

function pin() {
  pinned = pinned ? null : shown;
  $("pin").setAttribute("aria-pressed", Boolean(pinned));
  $("pin").textContent = pinned ? "Unpin" : "Pin curve";
  if (shown) drawCurves();
}

async function begin() {
  const form = await (await fetch("form")).json();
  ({ fields, kinds, start, expected } = form);
  build();
  state = linked();
  fill();
  $("undo").addEventListener("click", undo);
  $("reset").addEventListener("click", () => become({ ...start }));
  $("pin").addEventListener("click", pin);
  $("png").addEventListener("click", png);
  $("link").addEventListener("click", async () => {
    history.replaceState(null, "", link());
    try { await navigator.clipboard.writeText(location.href); say("The link is copied."); } catch { say("The address of this page is the link."); }
  });
  $("file").addEventListener("change", async () => {
    const [file] = $("file").files;
    $("file").value = "";
    if (file?.size > 9e4) say(`${file.name} has ${file.size} bytes: a scene has at most 90000.`, true);
    else if (file) await load({ name: file.name, text: await file.text() });
  });
  $("phase").addEventListener("input", () => turn($("phase").valueAsNumber));
  all("[data-file]").forEach((button) => button.addEventListener("click", () => carry(button.dataset.file)));
  all("[data-slow]").forEach((button) => button.addEventListener("click", () => demand(button.dataset.slow)));
  addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === "z" && !["number", "text"].includes(event.target.type)) { event.preventDefault(); undo(); }
  });
  addEventListener("hashchange", () => become(linked()));
  for (const media of ["(prefers-color-scheme: dark)", "print"]) matchMedia(media).addEventListener("change", () => shown && (drawMesh(), drawCurves()));
  if (form.open && !location.hash) await load(form.open); else await solve();
}
begin();

// The tooth turns by buttons too, which the keyboard reaches; figures fit the paper when the page is printed.
document.querySelectorAll("[data-turn]").forEach((button) => button.addEventListener("click", () => {
  const figure = document.getElementById(button.dataset.figure);
  const camera = figure._fullLayout.scene._scene.getCamera();
  const eye = [camera.eye.x, camera.eye.y, camera.eye.z], up = [camera.up.x, camera.up.y, camera.up.z];
  const unit = (v) => { const n = Math.hypot(...v); return v.map((x) => x / n); };
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const turned = (v, axis, t) => { const c = cross(axis, v), d = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    return v.map((x, i) => x * Math.cos(t) + c[i] * Math.sin(t) + axis[i] * d * (1 - Math.cos(t))); };
  const [kind, sign] = button.dataset.turn.split(" "), step = Number(sign) * Math.PI / 12;
  const axis = unit(kind === "around" ? up : cross(up, eye));
  const at = (v) => ({ x: v[0], y: v[1], z: v[2] });
  Plotly.relayout(figure, { "scene.camera": { ...camera, eye: at(turned(eye, axis, step)), up: at(turned(up, axis, step)) } });
}));
const plots = () => document.querySelectorAll(".js-plotly-plot");
const drawn = (one, width, height) => { one.parentElement.style.height = `${height}px`; Plotly.relayout(one, { width, height }); };
addEventListener("load", () => plots().forEach((one) => {  // a tooth is scaled by the height: a phone would cut it off
  if (one.layout.scene && one.clientWidth < 500) { drawn(one, null, 300); } }));
addEventListener("beforeprint", () => { document.querySelectorAll("details").forEach((one) => { one.open = true; });
  plots().forEach((one) => { one.dataset.height = one.layout.height; drawn(one, 680, Math.min(340, one.layout.height)); }); });
addEventListener("afterprint", () => plots().forEach((one) => drawn(one, null, Number(one.dataset.height))));

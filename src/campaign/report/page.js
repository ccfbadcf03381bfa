"use strict";
// One chart at a time; the circles of a chart are its points in order. A click pins what hovering shows.
const data = JSON.parse(document.getElementById("data").textContent);
const make = (tag, text, parent) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (parent) parent.append(element);
  return element;
};
const number = (v) => (v === undefined || v === null ? "" : v === 0 ? "0" : Number(v.toPrecision(4)).toString());
const title = (metric) => (data.metrics.find((m) => m[0] === metric) || ["", metric])[1];
const tip = document.getElementById("tip");
const state = { subject: 0, part: data.parts[0] || "", metric: data.charts.length ? data.charts[0].metric : "", sort: "ms", down: false, held: -1 };
const stages = [...new Set(data.dots.flatMap((d) => d.stages.map((s) => s[0])))];
const color = (stage) => data.colors[stages.indexOf(stage) % data.colors.length];

// Pictures of the table of scenes are those of the points.
document.querySelectorAll("img[data-dot]").forEach((image) => {
  const url = data.dots[Number(image.dataset.dot)][image.dataset.kind];
  if (url) image.src = url;
  else image.remove();
});

// Filters: boxes for few values, two ends for many numbers.
const filters = [];
for (const name of data.names) {
  const values = [...new Set(data.dots.map((d) => d.labels[name]).filter((v) => v !== undefined))];
  if (values.length < 2) continue;
  const set = make("fieldset", undefined, document.getElementById("filters"));
  make("legend", name, set);
  const numeric = values.every((v) => v.trim() !== "" && Number.isFinite(Number(v)));
  if (values.length > 12 && numeric) {
    const ends = [Math.min, Math.max].map((f) => {
      const input = make("input", undefined, set);
      input.type = "number";
      input.step = "any";
      input.value = f(...values.map(Number));
      input.addEventListener("input", update);
      return input;
    });
    filters.push((d) => d.labels[name] === undefined || (Number(d.labels[name]) >= Number(ends[0].value) && Number(d.labels[name]) <= Number(ends[1].value)));
  } else {
    const on = new Set(values);
    if (numeric) values.sort((a, b) => a - b);
    for (const value of values.slice(0, 60)) {
      const label = make("label", undefined, set);
      const box = make("input", undefined, label);
      box.type = "checkbox";
      box.checked = true;
      label.append(" " + value);
      box.addEventListener("change", () => { box.checked ? on.add(value) : on.delete(value); update(); });
    }
    filters.push((d) => d.labels[name] === undefined || on.has(d.labels[name]));
  }
}
const kept = (d) => d.subject === state.subject && filters.every((f) => f(d));

// Choices of what is charted.
function choice(title, field, options) {
  if (options.length < 1) return;
  const label = make("label", title + " ", document.getElementById("controls"));
  const select = make("select", undefined, label);
  for (const [value, text] of options) {
    const option = make("option", text, select);
    option.value = value;
    option.selected = String(value) === String(state[field]);
  }
  select.addEventListener("change", () => {
    state[field] = field === "subject" ? Number(select.value) : select.value;
    update();
  });
}
choice("View", "subject", data.subjects.map((s, i) => [i, s]));
choice("Light", "part", data.parts.map((p) => [p, p]));
choice("Error", "metric", [...new Set(data.charts.map((c) => c.metric))].map((m) => [m, title(m)]));

const errorOf = (d) => {
  const v = ((d.scores[state.part] || {})[state.metric]);
  return v === undefined || v === null ? undefined : data.metrics.some((m) => m[0] === state.metric && m[2]) ? Math.abs(Math.log(v)) : v;
};
// The points that none of those shown beats in both time and error.
function pareto(indices) {
  const order = indices.filter((i) => errorOf(data.dots[i]) !== undefined)
    .sort((a, b) => data.dots[a].ms - data.dots[b].ms || errorOf(data.dots[a]) - errorOf(data.dots[b]));
  let least = Infinity;
  return order.filter((i) => { const e = errorOf(data.dots[i]); const better = e < least; least = Math.min(least, e); return better; });
}

function describe(index, event, pinned) {
  const d = data.dots[index];
  tip.replaceChildren();
  tip.className = pinned ? "pinned" : "";
  make("b", data.names.filter((n) => d.labels[n] !== undefined).map((n) => n + " " + d.labels[n]).join(", ") || d.id, tip);
  make("div", `${number(d.ms)} ms (95 %: ${number(d.p95)}), ${number(d.bytes / 1048576)} MiB`, tip);
  for (const part of data.parts.filter((p) => d.scores[p])) {
    const s = d.scores[part];
    make("div", `${part}: ` + data.metrics.filter((m) => s[m[0]] !== undefined)
      .map((m) => `${m[1]} ${number(s[m[0]])}`).join(", "), tip);
  }
  for (const warning of d.warnings) make("div", "warning: " + warning, tip).className = "warning";
  const bar = make("div", undefined, tip);
  bar.className = "bar";
  const sum = d.stages.reduce((a, s) => a + s[1], 0) || 1;
  for (const [stage, ms] of d.stages) {
    const piece = make("span", undefined, bar);
    piece.style.width = (100 * ms) / sum + "%";
    piece.style.background = color(stage);
    piece.title = `${stage} ${number(ms)} ms`;
  }
  make("div", d.stages.map(([s, ms]) => `${s} ${number(ms)}`).join(", "), tip);
  for (const [url, name] of [[d.picture, "picture"], [d.error_map, "error"]]) {
    if (!url) continue;
    const image = make("img", undefined, tip);
    image.src = url;
    image.alt = name;
  }
  if (pinned) make("pre", d.experiment, tip);
  tip.hidden = false;
  const width = document.documentElement.clientWidth;
  tip.style.left = Math.max(8, Math.min(event.pageX + 14, window.scrollX + width - tip.offsetWidth - 8)) + "px";
  tip.style.top = event.pageY + 14 + "px";
}
function hover(element, index) {
  element.addEventListener("mouseenter", (e) => { if (state.held < 0) describe(index, e, false); });
  element.addEventListener("mouseleave", () => { if (state.held < 0) tip.hidden = true; });
  element.addEventListener("click", (e) => {
    e.stopPropagation();
    state.held = index;
    describe(index, e, true);
    update();
  });
}
document.addEventListener("click", (e) => {
  if (tip.contains(e.target) || state.held < 0) return;
  state.held = -1;
  tip.hidden = true;
  update();
});
document.querySelectorAll("figure[data-chart]").forEach((figure) => {
  const chart = data.charts[Number(figure.dataset.chart)];
  figure.querySelectorAll("circle").forEach((circle, i) => hover(circle, chart.points[i]));
});

const columns = [
  ...data.names.map((n) => [n, (d) => d.labels[n] ?? ""]),
  ["ms", (d) => d.ms], ["95 % ms", (d) => d.p95], ["MiB", (d) => d.bytes / 1048576],
  ...data.parts.flatMap((p) => [...new Set(data.charts.map((c) => c.metric))].map((m) => [`${p} ${title(m)}`, (d) => (d.scores[p] || {})[m]])),
];
function table(best) {
  const element = document.getElementById("points");
  element.replaceChildren();
  const head = make("tr", undefined, make("thead", undefined, element));
  for (const [name] of columns) {
    make("th", name + (state.sort === name ? (state.down ? " ▼" : " ▲") : ""), head).addEventListener("click", () => {
      state.down = state.sort === name && !state.down;
      state.sort = name;
      update();
    });
  }
  const value = columns.find((c) => c[0] === state.sort)[1];
  const order = data.dots.map((_, i) => i).filter((i) => kept(data.dots[i])).sort((a, b) => {
    const [x, y] = [value(data.dots[a]), value(data.dots[b])].map((v) => (v !== "" && Number.isFinite(Number(v)) ? Number(v) : v ?? ""));
    const sign = typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y));
    return (state.down ? -sign : sign) || a - b;
  });
  const body = make("tbody", undefined, element);
  for (const i of order) {
    const row = make("tr", undefined, body);
    if (best.includes(i)) row.classList.add("front");
    if (i === state.held) row.classList.add("held");
    for (const [, get] of columns) {
      const v = get(data.dots[i]);
      make("td", typeof v === "number" ? number(v) : v ?? "", row);
    }
    hover(row, i);
  }
}

function update() {
  document.getElementById("settings").textContent = data.settings[state.subject] || "";
  document.querySelectorAll("figure[data-passes]").forEach((f) => { f.hidden = Number(f.dataset.passes) !== state.subject; });
  const shown = data.dots.map((_, i) => i).filter((i) => kept(data.dots[i]));
  // Each colour of a chart has a front of its own.
  const charted = data.charts.find((c) => c.subject === state.subject && c.part === state.part && c.metric === state.metric);
  const groups = charted ? charted.colors.map((_, g) => shown.filter((i) => charted.groups[charted.points.indexOf(i)] === g)) : [];
  const fronts = groups.map(pareto);
  const best = fronts.flat();
  document.querySelectorAll("figure[data-chart]").forEach((figure) => {
    const chart = data.charts[Number(figure.dataset.chart)];
    figure.hidden = chart.subject !== state.subject || chart.part !== state.part || chart.metric !== state.metric;
    if (figure.hidden) return;
    const circles = [...figure.querySelectorAll("circle")];
    const at = new Map();
    circles.forEach((circle, i) => {
      const index = chart.points[i];
      const hollow = circle.dataset.hollow ?? (circle.dataset.hollow = circle.getAttribute("fill") === "none" ? "yes" : "no");
      const red = best.includes(index);
      const ink = red && chart.colors.length < 2 ? data.front : chart.colors[chart.groups[i]];
      circle.classList.toggle("off", !kept(data.dots[index]));
      circle.classList.toggle("held", index === state.held);
      circle.setAttribute("r", red ? 5 : 4);
      circle.setAttribute("fill", hollow === "yes" ? "none" : ink);
      circle.setAttribute("stroke", hollow === "yes" ? ink : "none");
      at.set(index, [Number(circle.getAttribute("cx")), Number(circle.getAttribute("cy"))]);
    });
    figure.querySelectorAll(`polyline[opacity='${data.bar_opacity}']`).forEach((bar, i) => {
      bar.style.display = kept(data.dots[chart.points[chart.bars[i]]]) ? "" : "none";
    });
    // The front of a colour is the first line that has it.
    chart.colors.forEach((color, group) => {
      const line = figure.querySelector(`polyline[stroke='${chart.colors.length < 2 ? data.front : color}']`);
      if (!line) return;
      const points = [];
      for (const i of fronts[group].filter((i) => at.has(i))) {
        if (points.length) points.push([at.get(i)[0], points[points.length - 1][1]]);
        points.push(at.get(i));
      }
      line.setAttribute("points", points.map((p) => p.join(",")).join(" "));
    });
  });
  table(best);
}
update();

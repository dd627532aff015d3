// One chart: uPlot in a figure, with zoom by drag, keys and buttons, redrawn when width or theme changes.
//
//   const c = chart(parent, { title, caption, data: [x, y1, y2], series: [{ label, stroke: 'blue' }], y: { label } });
//   c.figure.plot.scales.x.min                    // what is shown
//
// Colours are names of CSS variables (--c-blue): they follow the theme, and print is always light.

const charts = [];

const color = (name) => getComputedStyle(document.documentElement).getPropertyValue('--c-' + name).trim() || name;

const element = (tag, attributes = {}, text = '') => {
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
  if (text) e.textContent = text;
  return e;
};

const shown = (v) => (v === null || v === undefined ? '–' : Number(v.toPrecision(4)).toString().replace('-', '−'));

function axis(extra) {
  const grid = { stroke: color('grid'), width: 1 };
  return { stroke: color('text'), grid, ticks: grid, font: '12px system-ui', labelFont: '12px system-ui', ...extra };
}

function lineSeries(s) {
  const hidden = s.band === true;
  return {
    label: s.label, class: hidden ? 'band' : undefined, spanGaps: s.spanGaps ?? false,
    stroke: hidden ? 'transparent' : color(s.stroke), width: hidden ? 0 : (s.width ?? 1.5), dash: s.dash,
    points: { show: s.points ?? false, size: 7, fill: color(s.stroke ?? 'text') },
    paths: s.bars ? uPlot.paths.bars({ size: [0.6, 12] }) : undefined, fill: s.bars ? color(s.stroke) : undefined,
    value: (u, v) => shown(v),
  };
}

function options(spec, width, onScale) {
  const x = spec.x ?? {}, y = spec.y ?? {};
  return {
    width, height: spec.height ?? 240, pxAlign: 0,
    scales: { x: { time: false, ...(x.range ? { range: x.range } : {}) }, y: y.scale ?? {} },
    series: [{ label: x.label ?? x.legend, value: (u, v) => (x.name ? x.name(v) : shown(v)) }, ...spec.series.map(lineSeries)],
    bands: (spec.bands ?? []).map((b) => ({ series: b.series, fill: color(b.fill) })),
    axes: [axis({ label: x.label, splits: x.splits, values: x.values, size: x.size ?? 44, labelSize: 18 }),
           axis({ label: y.label, size: 64, labelSize: 18, values: y.values })],
    cursor: { drag: { x: spec.zoom !== false, y: false }, sync: spec.sync ? { key: spec.sync, scales: ['x', null] } : undefined },
    hooks: { draw: spec.draw ? [spec.draw] : [], setScale: [(u, key) => key === 'x' && onScale(u)] },
  };
}

function fullRange(u) {
  const x = u.data[0];
  return [x[0], x[x.length - 1]];
}

function zoom(u, factor, shift = 0) {
  const [lo, hi] = fullRange(u), { min, max } = u.scales.x;
  const span = Math.min((max - min) * factor, hi - lo);
  const from = Math.max(lo, Math.min((min + max) / 2 + shift * (max - min) - span / 2, hi - span));
  if (span > (hi - lo) * 1e-5) u.setScale('x', { min: from, max: from + span });
}

function zoomAll(u) {
  const [min, max] = fullRange(u);
  u.setScale('x', { min, max });
}

const zoomKeys = {
  '+': (u) => zoom(u, 0.5), '=': (u) => zoom(u, 0.5), '-': (u) => zoom(u, 2), '_': (u) => zoom(u, 2),
  ArrowLeft: (u) => zoom(u, 1, -0.25), ArrowRight: (u) => zoom(u, 1, 0.25), 0: zoomAll, Home: zoomAll, Escape: zoomAll,
};

function addButtons(c) {
  const bar = element('div', { class: 'zoom' });
  for (const [text, label, act] of [['+', 'Zoom in', zoomKeys['+']], ['−', 'Zoom out', zoomKeys['-']], ['all', 'Show all', zoomAll]]) {
    const b = element('button', { type: 'button', 'aria-label': label + ': ' + c.spec.title }, text);
    b.addEventListener('click', () => act(c.figure.plot));
    bar.append(b);
  }
  c.figure.append(bar);
}

function draw(c, width) {
  const old = c.figure.plot, range = old && c.spec.zoom !== false ? { min: old.scales.x.min, max: old.scales.x.max } : null;
  if (old) old.destroy();
  const u = new uPlot(options(c.spec, width, (plot) => follow(c, plot)), c.spec.data, c.holder);
  c.figure.plot = u;
  c.width = width;
  if (range && range.min != null) u.setScale('x', range);
}

// Charts of one group show the same stretch.
function follow(c, plot) {
  const { min, max } = plot.scales.x;
  for (const other of charts) {
    const u = other.figure.plot;
    if (other === c || !c.spec.sync || other.spec.sync !== c.spec.sync || !u || !u.scales) continue;
    if (u.scales.x.min !== min || u.scales.x.max !== max) u.setScale('x', { min, max });
  }
}

function chart(parent, spec) {
  const figure = element('figure', { tabindex: '0', role: 'group', 'aria-roledescription': 'chart', 'aria-label': spec.title });
  const caption = element('figcaption', {}, spec.title);
  if (spec.caption) caption.append(element('small', {}, ' ' + spec.caption));
  const c = { spec, figure, holder: element('div'), width: 0 };
  figure.append(caption, c.holder);
  parent.append(figure);
  charts.push(c);
  draw(c, Math.max(280, Math.floor(figure.clientWidth)));
  if (spec.zoom !== false) {
    addButtons(c);
    figure.addEventListener('keydown', (event) => {
      if (event.target !== figure || event.ctrlKey || event.metaKey || event.altKey || !zoomKeys[event.key]) return;
      event.preventDefault();
      zoomKeys[event.key](figure.plot);
    });
  }
  return c;
}

function removeCharts(parent) {
  for (let i = charts.length - 1; i >= 0; --i) {
    if (!parent.contains(charts[i].figure)) continue;
    charts[i].figure.plot.destroy();
    charts.splice(i, 1);
  }
  parent.replaceChildren();
}

function redrawAll(width = 0) {
  for (const c of charts) {
    const w = width || Math.floor(c.figure.clientWidth);
    if (w > 0) draw(c, Math.max(280, w));
  }
}

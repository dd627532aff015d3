// The charts of a diagnosis report, from the JSON that stands in the page.

const data = JSON.parse(document.getElementById('report-data').textContent);
const lineOf = {
  measured: { label: 'measured', stroke: 'soft', width: 3 },
  baseline: { label: 'before: refitted', stroke: 'orange', width: 1.5, dash: [6, 3] },
  final: { label: 'final model', stroke: 'blue', width: 1.25 },
};
const useStyles = { fit: { stroke: 'blue' }, holdout: { stroke: 'orange', dash: [8, 4] }, extrapolation: { stroke: 'green', dash: [2, 4] } };
const palette = ['blue', 'orange', 'green', 'red', 'purple', 'sky', 'text'];
const dashes = [undefined, [8, 4], [2, 3], [10, 3, 2, 3]];

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return new DataView(out.buffer);
}

function unpack(s) {
  const view = bytes(s.data), out = new Array(view.byteLength / 2);
  for (let i = 0; i < out.length; ++i) {
    const code = view.getUint16(2 * i, true);
    out[i] = code === 0 ? null : s.low + ((code - 1) / 65534) * (s.high - s.low);
  }
  return out;
}

function clock(o) {
  if (o.interval_s) return Array.from({ length: o.points }, (_, i) => o.interval_s * (i + 0.5) / 2);
  const view = bytes(o.time);
  return Array.from({ length: o.points }, (_, i) => view.getFloat32(4 * i, true));
}

const withUnit = (name, unit) => (unit && unit !== '1' ? `${name}, ${unit}` : name);

// Names of steps on an axis: one line per word.
const stepAxis = (steps) => ({
  splits: () => steps.map((_, i) => i), values: (u, at) => at.map((i) => (steps[i] ?? '').replace(/[ _]/g, '\n')),
  range: () => [-0.4, steps.length - 0.6], size: 64, legend: 'step', name: (i) => steps[i] ?? '–',
});

function drawLadder(parent) {
  const { steps, errors } = data.ladder;
  if (steps.length === 0) return;
  const uses = Object.keys(errors), all = uses.flatMap((u) => errors[u]).filter((v) => v > 0);
  const log = all.length > 0 && Math.max(...all) > 8 * Math.min(...all);
  chart(parent, {
    title: 'Error over noise after each step', caption: log ? '(logarithmic)' : '', zoom: false, height: 280,
    data: [steps.map((_, i) => i), ...uses.map((u) => errors[u])],
    series: uses.map((u) => ({ label: u, points: true, width: 2, ...useStyles[u] })),
    x: stepAxis(steps),
    y: { label: 'error / noise', scale: log ? { distr: 3 } : { range: (u, lo, hi) => [0, hi * 1.1] } },
  });
}

function drawDrift(parent) {
  const moved = data.drift, steps = data.ladder.steps;
  if (moved.length === 0 || steps.length < 2) return;
  chart(parent, {
    title: 'How base parameters moved', caption: '(grey: within twice the tolerance)', zoom: false, height: 260,
    data: [steps.map((_, i) => i), ...moved.map((p) => p.sigmas)],
    series: moved.map((p, i) => ({ label: p.path, points: true, stroke: palette[i % palette.length],
                                   dash: dashes[Math.floor(i / palette.length) % dashes.length] })),
    x: stepAxis(steps), y: { label: 'prior deviation, σ', scale: { range: (u, lo, hi) => [Math.min(-3, lo * 1.1), Math.max(3, hi * 1.1)] } },
    draw: (u) => shade(u, null, [-2, 2], 'soft'),
  });
}

// Fills a stretch of x (or all) and of y (or all).
function shade(u, xs, ys, fill) {
  const { ctx, bbox } = u;
  const at = (pair, scale, from, size) => (pair ? pair.map((v) => Math.min(Math.max(u.valToPos(v, scale, true), from), from + size)) : [from, from + size]);
  const [x0, x1] = at(xs, 'x', bbox.left, bbox.width), [y0, y1] = at(ys, 'y', bbox.top, bbox.height);
  ctx.save();
  ctx.globalAlpha = 0.25;
  ctx.fillStyle = color(fill);
  ctx.fillRect(Math.min(x0, x1), Math.min(y0, y1), Math.max(2, Math.abs(x1 - x0)), Math.abs(y1 - y0));
  ctx.restore();
}

function label(u, text, x, y, align = 'left') {
  const { ctx } = u;
  ctx.save();
  ctx.fillStyle = color('text');
  ctx.font = `${11 * devicePixelRatio}px system-ui`;
  ctx.textAlign = align;
  ctx.fillText(text, x, y);
  ctx.restore();
}

const center = (b) => ((b[0] ?? b[1]) + (b[1] ?? b[0])) / 2;
const curve = (bins) => [bins.map(center), bins.map((b) => b[2] + 2 * b[3]), bins.map((b) => b[2] - 2 * b[3]), bins.map((b) => b[2])];

function markWorst(u, map) {
  if (map.worst < 0) return;
  const b = map.baseline[map.worst];
  if (b[0] === null || b[1] === null) return;
  shade(u, [b[0], b[1]], null, 'red');
  const left = u.valToPos(b[0], 'x', true), rightHalf = left > u.bbox.left + u.bbox.width / 2;
  label(u, `worst: ${Math.round(100 * b[4])} % of the error in ${shown(Number((100 * b[5]).toPrecision(2)))} % of the time`,
        rightHalf ? Math.min(u.valToPos(b[1], 'x', true), u.bbox.left + u.bbox.width) : Math.max(left, u.bbox.left),
        u.bbox.top + 14 * devicePixelRatio, rightHalf ? 'right' : 'left');
}

function drawMap(parent, map) {
  const tables = [curve(map.baseline)];
  if (map.final) tables.push(curve(map.final));
  const group = (style, name) => [{ label: '', band: true, stroke: style.stroke }, { label: '', band: true, stroke: style.stroke },
                                  { ...style, label: name, points: true, spanGaps: true }];
  const share = (v) => `${Math.round(100 * Math.max(0, v ?? 0))} %`;
  const c = chart(parent, {
    title: `${map.signal} against ${map.axis}`, height: 220,
    caption: `on ${map.use}: explains ${share(map.explained)} of what is left over before` +
      (map.final ? `, ${share(map.explained_final)} at the end` : '') + '. ' + (map.sentence ?? ''),
    data: uPlot.join(tables), bands: [{ series: [1, 2], fill: 'orange-band' }, ...(map.final ? [{ series: [4, 5], fill: 'blue-band' }] : [])],
    series: [...group(lineOf.baseline, 'before'), ...(map.final ? group(lineOf.final, 'final') : [])],
    x: { label: withUnit(map.axis.replaceAll('_', ' '), map.unit) }, y: { label: withUnit('residual', map.signal_unit) },
    draw: (u) => markWorst(u, map),
  });
  c.figure.append(binTable(map));
}

function binTable(map) {
  const details = element('details', { class: 'numbers' }), table = element('table');
  details.append(element('summary', {}, 'Numbers'), table);
  const row = (tag, cells) => {
    const tr = element('tr');
    for (const cell of cells) tr.append(element(tag, {}, cell));
    table.append(tr);
  };
  row('th', ['from', 'to', 'mean before', '± σ', 'share of error', 'share of time']);
  for (const b of map.baseline) row('td', [...b.slice(0, 4).map(shown), ...b.slice(4).map((v) => `${Math.round(100 * v)} %`)]);
  return details;
}

function drawMaps(parent) {
  const first = 8;
  if (data.maps.length === 0) parent.append(element('p', {}, 'No regime was looked at.'));
  data.maps.slice(0, first).forEach((m) => drawMap(parent, m));
  const rest = data.maps.slice(first);
  if (rest.length === 0) return;
  const more = element('button', { type: 'button' }, `Show ${rest.length} more`);
  more.addEventListener('click', () => {
    more.remove();
    rest.forEach((m) => drawMap(parent, m));
  });
  parent.append(more);
  if (data.maps_left_out > 0) parent.append(element('p', {}, `${data.maps_left_out} further axes, where less is to be seen, are left out.`));
}

function drawOverlay(parent, o) {
  const t = clock(o), sync = `${o.run} ${o.signal}`;
  const detail = o.interval_s ? `least and greatest of each ${shown(1000 * o.interval_s)} ms; ` : '';
  chart(parent, {
    title: `${o.signal}: measured and model`, caption: `${detail}${o.samples} samples`, sync,
    data: [t, unpack(o.measured), unpack(o.baseline), unpack(o.final)], series: [lineOf.measured, lineOf.baseline, lineOf.final],
    x: { label: 'time, s' }, y: { label: withUnit(o.signal, o.unit) },
  });
  chart(parent, {
    title: `${o.signal}: residual`, caption: o.noise ? `grey: twice the noise, ${shown(o.noise)} ${o.unit}` : '', sync, height: 180,
    data: [t, unpack(o.residual_baseline), unpack(o.residual_final)], series: [lineOf.baseline, lineOf.final],
    x: { label: 'time, s' }, y: { label: withUnit('residual', o.unit) },
    draw: (u) => o.noise && shade(u, null, [-2 * o.noise, 2 * o.noise], 'soft'),
  });
}

function drawOverlays(parent) {
  const runs = [...new Map(data.overlays.map((o) => [o.run, o.use]))];
  if (runs.length === 0) return void parent.append(element('p', {}, 'No model was run against the measurement.'));
  const judged = runs.some(([, use]) => use === 'holdout') ? 'holdout' : 'fit';
  const worth = ([run, use]) => (use === judged ? 1 : 0) * (1 + Math.max(...data.overlays.filter((o) => o.run === run).map((o) => o.misfit ?? 0)));
  const start = runs.reduce((a, b) => (worth(b) > worth(a) ? b : a))[0];
  const select = element('select', { id: 'run' }), plots = element('div');
  for (const [run, use] of runs) select.append(element('option', { value: run, ...(run === start ? { selected: '' } : {}) }, `${run} (${use})`));
  const picker = element('p');
  picker.append(element('label', { for: 'run' }, 'Run: '), select);
  if (data.overlays_left_out > 0) picker.append(` ${data.overlays_left_out} signals that the model meets best are left out.`);
  parent.append(picker, plots);
  const show = () => {
    removeCharts(plots);
    data.overlays.filter((o) => o.run === select.value).forEach((o) => drawOverlay(plots, o));
  };
  select.addEventListener('change', show);
  show();
}

function drawSpectrum(parent, s) {
  const peaks = s.order.map((n, i) => [n, s.baseline[i] ?? 0]).filter(([, a]) => a > s.floor).sort((a, b) => b[1] - a[1]).slice(0, 4);
  chart(parent, {
    title: `${s.signal} against the ${s.angle.replaceAll('_', ' ')}`,
    caption: peaks.length ? `standing out: order ${peaks.map(([n]) => n).join(', ')}` : 'no order stands out',
    data: [s.order, s.baseline, s.final],
    series: [{ ...lineOf.baseline, label: 'before', dash: undefined, bars: true }, { ...lineOf.final, label: 'final' }],
    x: { label: 'order, per turn' }, y: { label: withUnit('amplitude', s.unit), scale: { range: (u, lo, hi) => [0, Math.max(hi, s.floor) * 1.15] } },
    draw: (u) => {
      shade(u, null, [0, s.floor], 'soft');
      for (const [n, a] of peaks) {
        if (n >= u.scales.x.min && n <= u.scales.x.max) label(u, String(n), u.valToPos(n, 'x', true), u.valToPos(a, 'y', true) - 4 * devicePixelRatio, 'center');
      }
    },
  });
}

function drawSpectra(parent) {
  if (data.spectra.length === 0) parent.append(element('p', {}, 'No run turned far enough, or no angle was measured.'));
  data.spectra.forEach((s) => drawSpectrum(parent, s));
}

function drawAll() {
  const places = { ladder: drawLadder, drift: drawDrift, maps: drawMaps, overlays: drawOverlays, spectra: drawSpectra };
  for (const [name, act] of Object.entries(places)) {
    const place = document.querySelector(`[data-chart="${name}"], [data-list="${name}"]`);
    if (place) act(place);
  }
}

function followThePage() {
  const root = document.documentElement;
  const dark = matchMedia('(prefers-color-scheme: dark)');
  document.getElementById('theme').addEventListener('click', () => {
    const now = root.dataset.theme ?? (dark.matches ? 'dark' : 'light');
    root.dataset.theme = now === 'dark' ? 'light' : 'dark';
    redrawAll();
  });
  dark.addEventListener('change', () => redrawAll());
  let width = root.clientWidth, waiting = 0;
  addEventListener('resize', () => {
    if (root.clientWidth === width) return;
    width = root.clientWidth;
    clearTimeout(waiting);
    waiting = setTimeout(redrawAll, 100);
  });
  addEventListener('beforeprint', () => {
    root.dataset.before = root.dataset.theme ?? '';
    root.dataset.theme = 'light';
    document.querySelectorAll('section > details').forEach((d) => { d.open = true; });
    redrawAll(660);
  });
  addEventListener('afterprint', () => {
    if (root.dataset.before) root.dataset.theme = root.dataset.before;
    else delete root.dataset.theme;
    redrawAll();
  });
  // A closed section has no width: its charts are drawn for what it has when it opens.
  document.querySelectorAll('section > details').forEach((d) => d.addEventListener('toggle', () => d.open && redrawAll()));
}

if (window.uPlot) drawAll();
followThePage();

// Opens a report in Debian's chromium and holds one property of it: node report.mjs PROPERTY PAGE [MOST_BYTES].
// node report.mjs picture PAGE OUT.png: its first page as a picture.
// Exit 0: holds; 1: does not, said why; 77: cannot be looked at here (no chromium, no playwright-core), said why.
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { inflateSync } from 'node:zlib';

const sections = ['verdict', 'ladder', 'where', 'overlays', 'spectrum', 'ranking', 'parameters', 'data', 'invisible', 'next', 'unknown', 'about'];
const titles = ['Error, step by step', 'Where the error is', 'Measured against model', 'Against the angle', 'Which effect',
                'Numbers of the model', 'Quality of the data', 'Not visible in these data', 'Next experiment', 'Unknown structure'];

function skip(why) {
  console.log('skipped: ' + why);
  process.exit(77);
}

function check(holds, what) {
  if (!holds) throw new Error(what);
}

const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;
const range = (page, at) => page.$eval(at, (f) => [f.plot.scales.x.min, f.plot.scales.x.max]);
const firstOverlay = '#overlays figure';

// Share of a chart's pixels that are not the background, and how many colours there are.
const inked = (page, at) => page.$$eval(at, (figures) => figures.map((f) => {
  const canvas = f.querySelector('canvas'), { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const colours = new Set();
  let ink = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] > 0) ++ink, colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
  }
  return { ink: ink / (data.length / 4), colours: colours.size, name: f.getAttribute('aria-label') };
}));

// Text of a PDF, roughly: how often its compressed streams draw, and its pages.
function pdfFigures(pdf) {
  const raw = pdf.toString('latin1');
  let operators = 0;
  for (const m of raw.matchAll(/\/FlateDecode[^]*?stream\r?\n/g)) {
    try {
      operators += (inflateSync(pdf.subarray(m.index + m[0].length)).toString('latin1').match(/ T[jJ]\b/g) ?? []).length;
    } catch { /* a stream that is not text */ }
  }
  return { pages: (raw.match(/\/Type\s*\/Page\b/g) ?? []).length, operators };
}

const properties = {
  async FileStaysBelowThreeMegabytes(page, file) {
    check(statSync(file).size < 3e6, `${statSync(file).size} bytes`);
  },
  async NothingIsAskedOfTheNetwork(page, file, seen) {
    const foreign = seen.requests.filter((url) => !url.startsWith('file://') && !url.startsWith('data:'));
    check(foreign.length === 0, 'asked for ' + foreign.join(', '));
    check(seen.requests.filter((url) => url.startsWith('file://')).length === 1, 'asked for other files: ' + seen.requests.join(', '));
  },
  async ConsoleIsQuiet(page, file, seen) {
    await page.click('#theme');
    check(seen.errors.length === 0, seen.errors.join('\n'));
  },
  async EverySectionIsVisible(page) {
    for (const id of sections) {
      const box = await (await page.$('section#' + id))?.boundingBox();
      check(box && box.height > 20, `section ${id} is not to be seen`);
    }
  },
  async EveryChartHasInk(page) {
    const all = await inked(page, 'figure');
    check(all.length >= 6, `${all.length} charts`);
    for (const c of all) check(c.ink > 0.01 && c.colours > 2, `"${c.name}" is blank: ${c.ink} ink, ${c.colours} colours`);
  },
  async DraggingZoomsTheChartAndItsResidual(page) {
    const before = await range(page, firstOverlay);
    await page.$eval(firstOverlay, (f) => f.scrollIntoView({ block: 'center' }));
    const box = await (await page.$(firstOverlay + ' .u-over')).boundingBox();
    await page.mouse.move(box.x + 0.25 * box.width, box.y + 50);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.75 * box.width, box.y + 60, { steps: 5 });
    await page.mouse.up();
    const after = await range(page, firstOverlay), span = before[1] - before[0];
    check(near(after[1] - after[0], 0.5 * span, 0.03 * span), `${before} became ${after}`);
    const residual = await page.$$eval('#overlays figure', (f) => [f[1].plot.scales.x.min, f[1].plot.scales.x.max]);
    check(near(residual[0], after[0], 1e-6) && near(residual[1], after[1], 1e-6), `the residual shows ${residual}`);
    await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 50);
    const reset = await range(page, firstOverlay);
    check(near(reset[0], before[0], 1e-6) && near(reset[1], before[1], 1e-6), `after a double click ${reset}`);
  },
  async KeysZoomMoveAndGoBack(page) {
    const before = await range(page, firstOverlay), span = before[1] - before[0];
    await page.focus(firstOverlay);
    await page.keyboard.press('+');
    await page.keyboard.press('+');
    const zoomed = await range(page, firstOverlay);
    check(near(zoomed[1] - zoomed[0], span / 4, 1e-6 * span), `${before} became ${zoomed}`);
    await page.keyboard.press('ArrowRight');
    const moved = await range(page, firstOverlay);
    check(near(moved[0] - zoomed[0], span / 16, 1e-6 * span), `${zoomed} became ${moved}`);
    await page.keyboard.press('0');
    const reset = await range(page, firstOverlay);
    check(near(reset[0], before[0], 1e-6) && near(reset[1], before[1], 1e-6), `0 gives ${reset}`);
  },
  async TabReachesEverythingInOrder(page) {
    const reached = [];
    for (let i = 0; i < 400; ++i) {
      await page.keyboard.press('Tab');
      const at = await page.evaluate(() => {
        const e = document.activeElement;
        if (!e || e === document.body) return null;
        return { tag: e.tagName, section: e.closest('section')?.id ?? 'top', outline: getComputedStyle(e).outlineStyle };
      });
      if (!at) break;
      check(at.outline !== 'none', `focus on ${at.tag} in ${at.section} is not shown`);
      reached.push(at);
    }
    for (const tag of ['A', 'SUMMARY', 'FIGURE', 'SELECT', 'BUTTON']) check(reached.some((r) => r.tag === tag), `no ${tag} reached`);
    const order = [...new Set(reached.map((r) => r.section))].filter((s) => s !== 'top');
    const wanted = sections.filter((s) => order.includes(s));
    check(order.join() === wanted.join() && order.length >= sections.length - 1, `order ${order}`);
  },
  async AnotherRunIsShownWhenChosen(page) {
    const runs = await page.$$eval('#run option', (o) => o.map((x) => x.value));
    check(runs.length > 1, 'one run only');
    const chosen = await page.$eval('#run', (s) => s.value), other = runs.find((r) => r !== chosen);
    const before = await page.$$eval('#overlays figure', (f) => f.length);
    await page.selectOption('#run', { value: other });
    const after = await page.$$eval('#overlays figure', (f) => f.length);
    check(after !== before && after > 0, `${before} charts before, ${after} after`);
  },
  async DarkAndLightDiffer(page) {
    const back = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const lines = async () => (await inked(page, firstOverlay))[0].colours;
    const light = await back();
    await page.emulateMedia({ colorScheme: 'dark' });
    check(light !== (await back()), 'dark looks as light');
    await page.emulateMedia({ colorScheme: 'light' });
    await page.click('#theme');
    check(light !== (await back()) && (await lines()) > 2, 'the button changes nothing');
  },
  async PrintHasEverySection(page, file) {
    await page.$$eval('section > details', (all) => all.forEach((d) => { d.open = false; }));
    const pdf = await page.pdf({ format: 'A4' });
    const { pages, operators } = pdfFigures(pdf);
    check(pages >= 3 && pages < 40, `${pages} pages`);
    check(operators > 100, `${operators} pieces of text`);
    await page.emulateMedia({ media: 'print' });
    await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
    const text = await page.evaluate(() => document.body.innerText);
    for (const title of titles) check(text.includes(title), `"${title}" is not printed`);
    const widths = await page.$$eval('figure canvas', (all) => all.map((c) => c.getBoundingClientRect().width));
    check(widths.length > 0 && widths.every((w) => w > 200 && w <= 700), `charts ${widths} wide`);
  },
  async NamesOfTheDatasetRunNothing(page) {
    check((await page.$$('img')).length === 0, 'a name became an image');
    check((await page.$$('script')).length === 3, 'a name became a script');
  },
};

async function main() {
  const [property, file, picture] = process.argv.slice(2);
  if (!(property in properties) && property !== 'picture') throw new Error(`properties: ${Object.keys(properties).join(' ')}`);
  const chromium = process.env.OMNIHIL_CHROMIUM ?? '/usr/bin/chromium';
  if (!existsSync(chromium)) skip(`no browser at ${chromium} (package chromium)`);
  const client = process.env.OMNIHIL_BROWSER_NPM + '/node_modules/playwright-core';
  if (!existsSync(client)) skip(`playwright-core is not there: npm could not fetch it when the tests were built`);
  if (!readFileSync(file, 'utf8').includes('uPlot')) skip('the report was built without uPlot');
  const browser = await createRequire(import.meta.url)(client).chromium.launch({ executablePath: chromium, args: ['--no-sandbox'], timeout: 200000 });
  try {
    const page = await browser.newPage({ viewport: { width: 1100, height: 1000 }, colorScheme: 'light' });
    page.setDefaultTimeout(200000);
    const seen = { requests: [], errors: [] };
    page.on('request', (r) => seen.requests.push(r.url()));
    page.on('pageerror', (e) => seen.errors.push(String(e)));
    page.on('console', (m) => ['error', 'warning'].includes(m.type()) && seen.errors.push(m.text()));
    await page.goto(pathToFileURL(file).href);
    if (property === 'picture') writeFileSync(picture, await page.screenshot());
    else await properties[property](page, file, seen);
    if (seen.errors.length > 0) throw new Error('console: ' + seen.errors.join('\n'));
  } finally {
    await browser.close();
  }
}

main().catch((e) => {
  console.error(e.message);
  process.exit(1);
});

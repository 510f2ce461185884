// ---- validation curves, drawn as SVG

const CHART = { width: 380, height: 240, left: 44, right: 10, top: 10, bottom: 36 };
const DASHES = ['', '7 3', '2 3', '8 3 2 3', '4 2', '1 2'];
const lineStyle = i => `stroke: var(--line-${i % 6}); stroke-dasharray: ${DASHES[i % DASHES.length] || 'none'}`;

/** Round numbers from 0 up to at least `most`: about `steps` of them. */
function ticks(most, steps) {
  const rough = (most || 1) / steps, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map(x => x * power).find(x => x >= rough * (1 - 1e-9)) ?? 10 * power;
  return Array.from({ length: Math.ceil((most || 1) / step - 1e-9) + 1 }, (_, i) => i * step);
}
/** The point of the curve at the rounds that were kept. */
const chosenPoint = curve => curve.points.filter(([rounds]) => rounds <= curve.chosen).at(-1);

/** Path through the points; a missing value leaves a gap. */
function pathOf(points, column, x, y) {
  let path = '', pen = 'M';
  for (const point of points) {
    if (point[column] === null) { pen = 'M'; continue; }
    path += `${pen}${x(point[0]).toFixed(1)} ${y(point[column]).toFixed(1)}`;
    pen = 'L';
  }
  return path;
}
function axes(xTicks, yTicks, x, y, format, title) {
  const { width, height, left, right, top, bottom } = CHART;
  return drawn('g', { class: 'axes' },
    ...yTicks.flatMap(v => [drawn('line', { x1: left, x2: width - right, y1: y(v), y2: y(v) }), drawn('text', { x: left - 6, y: y(v) + 4, 'text-anchor': 'end', text: format(v) })]),
    ...xTicks.map(v => drawn('text', { x: x(v), y: height - bottom + 16, 'text-anchor': 'middle', text: String(v) })),
    drawn('text', { x: (left + width - right) / 2, y: height - 4, 'text-anchor': 'middle', text: 'rounds' }),
    drawn('line', { class: 'base', x1: left, x2: left, y1: top, y2: height - bottom }),
    drawn('title', { text: title }));
}
/** One chart of a column of the points: 1 = loss, 2 = error. */
function chart(curves, column, title, format) {
  const { width, height, left, right, top, bottom } = CHART;
  const points = curves.flatMap(curve => curve.points);
  const xTicks = ticks(Math.max(...points.map(p => p[0]), 0), 5), yTicks = ticks(Math.max(...points.map(p => p[column] ?? 0), 0), 5);
  const x = v => left + v / xTicks.at(-1) * (width - left - right), y = v => height - bottom - v / yTicks.at(-1) * (height - top - bottom);
  const svg = drawn('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${title} over the rounds; the table below has the numbers` }, axes(xTicks, yTicks, x, y, format, title));
  curves.forEach((curve, i) => {
    svg.append(drawn('path', { class: 'curve', d: pathOf(curve.points, column, x, y), style: lineStyle(i) }));
    const chosen = chosenPoint(curve);
    if (chosen && chosen[column] !== null)
      svg.append(drawn('circle', { cx: x(chosen[0]), cy: y(chosen[column]), r: 4, style: `fill: var(--line-${i % 6})` }, drawn('title', { text: `${curve.name}: ${format(chosen[column])} after ${chosen[0]} rounds` })));
  });
  return element('figure', {}, element('figcaption', { class: 'small', text: title }), svg);
}
function curveRow(curve, i) {
  const sample = drawn('svg', { class: 'sample', viewBox: '0 0 30 10', 'aria-hidden': 'true' }, drawn('path', { class: 'curve', d: 'M1 5L29 5', style: lineStyle(i) }));
  const [, loss, error] = chosenPoint(curve) ?? [0, null, null];
  return element('tr', {}, element('th', { scope: 'row' }, sample, curve.name + (curve.kept ? '' : ' (dropped)')), numberCell(curve.chosen ? count(curve.chosen) : '–'),
                 numberCell(loss === null ? '–' : loss.toPrecision(3)), numberCell(error === null ? '–' : percent(error, 2)));
}
function curvesPanel({ curves }) {
  const charts = [];
  const has = column => curves.some(curve => curve.points.some(point => point[column] !== null));
  if (has(1)) charts.push(chart(curves, 1, 'Log loss', v => String(Number(v.toPrecision(3)))));
  if (has(2)) charts.push(chart(curves, 2, 'Wrong labels', v => `${Number((100 * v).toPrecision(3))}%`));
  const head = ['classifier', 'rounds kept', 'log loss', 'wrong labels'].map((text, i) => element('th', { scope: 'col', class: i ? 'soft number' : 'soft', text }));
  const table = element('table', { class: 'rows numbers classifiers' }, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...curves.map(curveRow)));
  return panel('Validation', 'On training meshes that the classifier did not see, after so many rounds of boosting; the dot marks the rounds that were kept, and a classifier that did not help was dropped.',
               element('div', { class: 'charts' }, ...charts), scrollable('Validation of each classifier', table));
}

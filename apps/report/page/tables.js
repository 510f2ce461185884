// ---- tables of a group

function panel(title, note, ...content) {
  return element('section', { class: 'panel' }, element('h3', { text: title }),
                 ...(note ? [element('p', { class: 'soft small', text: note })] : []), ...content);
}
/** A region that scrolls sideways, by keyboard too, where its content is too wide. */
function scrollable(name, content, kind = '') {
  return element('div', { class: `scroll ${kind}`, tabindex: 0, role: 'region', 'aria-label': name }, content);
}
const WIDE_CONFUSION = 8;
function confusionCell(share, total, right, description) {
  // At most half covered, the cell keeps its number readable in the color of all text.
  const strength = share < 5e-4 ? 0 : Math.round(5 + 45 * Math.sqrt(share));
  const style = strength ? { background: `rgb(${right ? 'var(--good-rgb)' : 'var(--bad-rgb)'} / ${strength}%)` } : {};
  return element('td', { style, text: strength ? (100 * share).toFixed(1) : '·', title: `${description}: ${percent(share)} of the row, ${percent(total, 2)} of all area` });
}
/** The entries off the diagonal that cover most area, in words. */
function worstConfusions({ labels, confusion }) {
  const n = labels.length, all = confusion.reduce((a, b) => a + b, 0) || 1;
  return confusion.map((share, i) => ({ share: share / all, truth: Math.floor(i / n), predicted: i % n }))
    .filter(({ share, truth, predicted }) => truth !== predicted && share >= 1e-3).sort((a, b) => b.share - a.share).slice(0, 3)
    .map(({ share, truth, predicted }) => `${labels[truth]} taken for ${labels[predicted]} (${percent(share)})`);
}
function confusionPanel(group) {
  const { labels, colors, confusion } = group;
  const n = labels.length, all = confusion.reduce((a, b) => a + b, 0) || 1;
  const head = element('tr', {}, element('td'), ...labels.map((label, l) => element('th', { scope: 'col', title: label }, element('span', {}, swatch(colors[l]), label))),
                       element('th', { scope: 'col', class: 'soft' }, element('span', { text: 'share' })));
  const rows = labels.map((label, t) => {
    const row = confusion.slice(t * n, t * n + n), sum = row.reduce((a, b) => a + b, 0);
    const cells = row.map((x, p) => sum > 0 ? confusionCell(x / sum, x / all, t === p, `${label} labeled ${labels[p]}`) : element('td', { class: 'soft', text: '–' }));
    return element('tr', {}, element('th', { scope: 'row', title: label }, swatch(colors[t]), label), ...cells, element('td', { class: 'share', text: percent(sum / all) }));
  });
  const table = element('table', { class: n > 7 ? 'confusion many' : 'confusion' }, element('thead', {}, head), element('tbody', {}, ...rows));
  const note = 'Row: true part. Column: predicted part. Percent of the true part’s area; at the right its share of all area.';
  const worst = worstConfusions(group);
  return panel('Confusion', note, scrollable('Confusion table', table),
               ...(worst.length ? [element('p', { class: 'small after', text: `Most of all area: ${worst.join(', ')}.` })] : []));
}

// ---- chosen features

/** Families with their stumps in each stage and in all, those used most first; without stages the totals alone. */
function familyRows({ families, stages }) {
  const counts = stages.map(stage => new Map(stage.families));
  const names = [...new Set([...families, ...stages.flatMap(stage => stage.families)].map(([name]) => name))];
  const total = new Map(families);
  return names.map(name => {
    const perStage = counts.map(c => c.get(name) ?? 0);
    return { name, perStage, total: total.get(name) ?? perStage.reduce((a, b) => a + b, 0) };
  }).sort((a, b) => b.total - a.total);
}
function familyTable(group) {
  const rows = familyRows(group), sums = group.stages.map((_, s) => rows.reduce((sum, row) => sum + row.perStage[s], 0) || 1);
  const most = Math.max(...rows.map(row => row.total), 0) || 1, all = rows.reduce((sum, row) => sum + row.total, 0) || 1;
  const head = ['family', '', 'all', ...group.stages.map(({ stage }) => stage)].map((text, i) => element('th', { scope: 'col', class: i > 1 ? 'soft number' : 'soft', text }));
  const share = (n, sum) => numberCell(n ? percent(n / sum, 0) : '·', { title: `${count(n)} stumps`, style: { background: `rgb(var(--good-rgb) / ${Math.round(50 * n / sum)}%)` } });
  return element('table', { class: 'rows families' }, element('thead', {}, element('tr', {}, ...head)),
    element('tbody', {}, ...rows.map(row => element('tr', {}, element('th', { scope: 'row', text: row.name }),
      element('td', { class: 'bar', 'aria-hidden': 'true' }, element('i', { style: { width: `${100 * row.total / most}%` } })),
      numberCell(`${count(row.total)} (${percent(row.total / all, 0)})`), ...row.perStage.map((n, s) => share(n, sums[s]))))));
}
function featuresPanel(group) {
  const { families, stages, features } = group, content = [], counted = families.length || stages.length;
  if (counted) content.push(scrollable('Chosen features per family', familyTable(group)));
  if (features.length)
    content.push(element('ol', { class: 'features', 'aria-label': 'First features chosen' }, ...features.slice(0, 10).map(f => element('li', {}, element('code', { text: f })))));
  const note = [counted && 'Stumps per family of features', stages.length && 'the share of each in every classifier', features.length && 'the features chosen first'].filter(Boolean).join('; ') + '.';
  return panel('Chosen features', note, ...content);
}
function timingsPanel({ timings }) {
  const rows = timings.map(([what, seconds]) => element('tr', {}, element('th', { scope: 'row', text: what }), numberCell(duration(seconds))));
  return panel('Time', 'Wall time of each step.', element('table', { class: 'rows' }, element('tbody', {}, ...rows)));
}
/** A table of texts; columns of numbers are set right. */
function tablePanel({ title, note, columns, rows }) {
  const right = columns.map((_, c) => c > 0 && rows.some(row => row[c]) && rows.every(row => /^([\d.,]+( %| s)?|–)?$/.test(row[c])));
  const head = columns.map((text, c) => element('th', { scope: 'col', class: right[c] ? 'soft number' : 'soft', text }));
  const lines = rows.map(([name, ...texts]) => element('tr', {}, element('th', { scope: 'row', text: name }),
    ...texts.map((text, c) => element('td', { class: right[c + 1] ? 'number' : null, text }))));
  const table = element('table', { class: 'wide-table texts' }, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...lines));
  return panel(title, note, scrollable(title, table, rows.length > 15 ? 'tall' : ''));
}
/** Two columns of panels that are each as wide as half the page; one if the other is empty. */
function columns(left, right) {
  const filled = [left, right].filter(panels => panels.length).map(panels => element('div', {}, ...panels));
  return filled.length ? [element('div', { class: 'columns' }, ...filled)] : [];
}
function showTables(group) {
  const some = (given, make) => given.length ? [make(group)] : [];
  const measures = some(group.measures, measuresPanel), timings = some(group.timings, timingsPanel), confusion = some(group.confusion, confusionPanel);
  const wide = group.labels.length > WIDE_CONFUSION;
  $('panels').replaceChildren(
    ...(wide ? [...confusion, ...columns(measures, timings)] : columns([...measures, ...timings], confusion)),
    ...some(group.scores, scoresPanel), ...some(group.curves, curvesPanel),
    ...some([...group.families, ...group.stages, ...group.features], featuresPanel),
    ...group.tables.map(tablePanel));
}

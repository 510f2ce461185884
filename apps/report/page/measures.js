// ---- measures: of a group, of all groups, of each tested mesh

const groupName = (group, g) => group.title || `Group ${g + 1}`;
const shown = (value, share) => value === null ? '–' : share ? (100 * value).toFixed(1) : value.toFixed(3);
const mean = values => values.length ? values.reduce((a, b) => a + b, 0) / values.length : null;
/** Name, unit and the direction that is better, e.g. "Rand index error, % ↓". */
const measureTitle = measure => `${measure.name}${measure.share ? ', %' : ''} ${measure.lower ? '↓' : '↑'}`;
const DIRECTIONS = '↑ higher is better, ↓ lower is better.';
const initial = text => text.charAt(0).toUpperCase() + text.slice(1);

function numberCell(text, attributes = {}) { return element('td', { class: 'number', ...attributes, text }); }
/** How much better or worse than the reference a value is, in words, so that nothing hangs on the color. */
function differenceCell({ value, reference, lower, share }) {
  if (value === null || reference === null) return numberCell('–', { class: 'number soft' });
  const gain = lower ? reference - value : value - reference, text = shown(Math.abs(gain), share);
  const word = Number(text) === 0 ? 'equal' : gain > 0 ? 'better' : 'worse';
  return numberCell(word === 'equal' ? word : `${text} ${word}`, { class: `number ${word}` });
}
/** One measure per name that has a value anywhere, in the order of their first appearance; `compared` if any has a reference. */
function measureColumns(lists) {
  const columns = new Map();
  for (const measure of lists.flat().filter(m => m.value !== null)) {
    const column = columns.get(measure.name) ?? { ...measure, compared: false };
    column.compared ||= measure.reference !== null;
    columns.set(measure.name, column);
  }
  return [...columns.values()];
}
const missing = column => ({ ...column, value: null, reference: null });

/** Cells of one row of the overview: value, and reference and difference where the column has them. */
function comparedCells(measure, column) {
  const value = numberCell(shown(measure.value, measure.share), { class: 'number first' });
  if (!column.compared) return [value];
  return [value, numberCell(shown(measure.reference, measure.share), { class: 'number soft' }), differenceCell(measure)];
}
/** Mean over the groups that have the measure; compared over those that also have a reference. */
function meanMeasure(groups, column) {
  const own = groups.map(group => group.measures.find(m => m.name === column.name)).filter(m => m && m.value !== null);
  const both = own.filter(m => m.reference !== null), all = both.length === own.length;
  return { ...column, value: mean((all || !both.length ? own : both).map(m => m.value)), reference: mean(both.map(m => m.reference)), groups: all ? own.length : both.length || own.length };
}
function overviewPanel(groups) {
  const columns = measureColumns(groups.map(group => group.measures));
  if (!columns.length) return [];
  const reference = groups.find(group => group.measures.some(m => m.reference !== null))?.reference;
  const spanned = columns.map(c => element('th', { scope: 'colgroup', colspan: c.compared ? 3 : 1, text: initial(measureTitle(c)) }));
  const names = columns.flatMap(c => (c.compared ? ['here', reference, 'difference'] : ['here']).map((text, i) => element('th', { scope: 'col', class: i ? 'soft' : 'soft first', text })));
  const rows = groups.map((group, g) => element('tr', {},
    element('th', { scope: 'row' }, element('a', { href: `#group-${g + 1}`, text: groupName(group, g) })),
    ...columns.flatMap(c => comparedCells(group.measures.find(m => m.name === c.name) ?? missing(c), c))));
  const means = columns.map(c => meanMeasure(groups, c));
  const partial = means.some(m => m.groups < groups.length);
  const foot = element('tr', {}, element('th', { scope: 'row', text: `Mean of ${groups.length}` }), ...means.flatMap((m, i) => comparedCells(m, columns[i])));
  const table = element('table', { class: 'wide-table overview' },
    element('thead', {}, element('tr', {}, element('td', { rowspan: 2 }), ...spanned), element('tr', {}, ...names)),
    element('tbody', {}, ...rows), element('tfoot', {}, foot));
  const note = DIRECTIONS + (partial ? ' A mean leaves out the groups that lack the number or, where compared, its reference.' : '');
  return [panel('All groups', note, scrollable('Table of all groups', table))];
}

function measuresPanel({ measures, reference }) {
  const compared = measures.some(m => m.reference !== null);
  const head = ['', 'here', ...(compared ? [reference, 'difference'] : [])].map(text => element('th', { scope: 'col', class: 'soft number', text }));
  const rows = measures.map(m => element('tr', {}, element('th', { scope: 'row', text: initial(measureTitle(m)) }), numberCell(shown(m.value, m.share)),
    ...(compared ? [numberCell(shown(m.reference, m.share), { class: 'number soft' }), differenceCell(m)] : [])));
  const table = element('table', { class: 'rows numbers' }, element('thead', {}, element('tr', {}, ...head)), element('tbody', {}, ...rows));
  return panel('Measures', `Means over the tested meshes. ${DIRECTIONS}`, scrollable('Measures', table));
}

/** A table whose columns sort it; the first click on a column puts its worst mesh on top. */
function scoresPanel({ scores }) {
  const columns = measureColumns(scores.map(score => score.measures));
  const value = (score, name) => score.measures.find(m => m.name === name)?.value ?? null;
  const body = element('tbody'), heads = columns.map((column, c) => element('th', { scope: 'col' }, element('button', { type: 'button', text: initial(measureTitle(column)), onclick: () => sort(c) })));
  let order = { c: -1, sign: 1 };
  const sort = c => {
    const { name, lower } = columns[c];
    order = { c, sign: order.c === c ? -order.sign : lower ? -1 : 1 };
    const rank = score => { const v = value(score, name); return v === null ? Infinity : order.sign * v; };
    const sorted = [...scores].sort((a, b) => rank(a) - rank(b) || 0);
    body.replaceChildren(...sorted.map(score => element('tr', {}, element('th', { scope: 'row', text: score.name }), ...columns.map(m => numberCell(shown(value(score, m.name), m.share))))));
    heads.forEach((head, i) => i === c ? head.setAttribute('aria-sort', order.sign > 0 ? 'ascending' : 'descending') : head.removeAttribute('aria-sort'));
  };
  if (columns.length) sort(0);
  const table = element('table', { class: 'wide-table scores' }, element('thead', {}, element('tr', {}, element('th', { scope: 'col', text: 'Mesh' }), ...heads)), body);
  return panel('Tested meshes', `${count(scores.length)} meshes, the worst first; a column’s title sorts by it. ${DIRECTIONS}`, scrollable('Scores of the tested meshes', table, 'tall'));
}
function showFigures(group) {
  $('figures').replaceChildren(...group.summary.map(([key, value]) => element('div', {}, element('dt', { text: key }), element('dd', { text: value, class: value.length > 14 ? 'long' : null }))));
}

// ---- the meshes: cards with one view each, or with three side by side

function viewLabel(mesh, mode) {
  const rate = mesh.rate === null ? '' : `, ${percent(mesh.rate)} of the area right`;
  return `${MODES[mode ?? state.mode]} of mesh ${mesh.name}${rate}. Arrow keys turn, plus and minus zoom, 0 resets, Enter enlarges.`;
}
/** The views of a mesh in the page's mode: canvases (with captions if side by side) and the views in them. */
function viewsOf(mesh, detail, inDialog) {
  const modes = state.mode === 'compare' ? COMPARED : [null];
  const views = [], parts = modes.map((mode, i) => {
    // The views of a mesh turn together, so the first is enough for the keyboard to stop at.
    const canvas = element('canvas', { tabindex: i ? -1 : 0, role: 'img', 'aria-label': viewLabel(mesh, mode) });
    views.push(new View(canvas, mesh, mode, detail, inDialog));
    canvas.hidden = !renderer.gl;
    resizes.observe(canvas);
    if (!inDialog) sightings.observe(canvas);
    return mode ? element('figure', { class: 'compared' }, canvas, element('figcaption', { class: 'soft', text: MODES[mode] })) : canvas;
  });
  return { views, parts };
}
function forget(views) {
  for (const { canvas } of views) {
    sightings.unobserve(canvas);
    resizes.unobserve(canvas);
  }
}
function card(mesh) {
  const detail = element('div', { class: 'detail' });
  const name = element('div', { class: 'name' }, element('span', { text: mesh.name, title: mesh.name }));
  if (mesh.rate !== null) name.append(element('span', { class: 'number', text: percent(mesh.rate), title: 'Share of the area labeled right' }));
  const enlarge = element('button', { class: 'enlarge', type: 'button', title: 'Enlarge', 'aria-label': `Enlarge ${mesh.name}`, onclick: () => openLarge(mesh) },
                          $('enlarge-icon').content.cloneNode(true));
  enlarge.hidden = !renderer.gl;
  const { views, parts } = viewsOf(mesh, detail, false);
  const item = element('li', { class: 'card' }, element('div', { class: 'views' }, ...parts), enlarge, element('div', { class: 'caption' }, name, detail));
  return { mesh, item, views };
}
function showMeshes(group) {
  forget(state.views);
  const cards = group.meshes.map(card), compared = state.mode === 'compare';
  state.views = cards.flatMap(c => c.views);
  $('meshes').hidden = !cards.length;
  $('grid').classList.toggle('compare', compared);
  $('grid').classList.toggle('few', !compared && cards.length < 4);
  const rated = group.meshes.filter(m => m.rate !== null).length > 1;
  $('order-field').hidden = !rated;
  const order = () => {
    const sign = { given: 0, worst: 1, best: -1 }[$('order').value];
    const rank = ({ mesh }) => mesh.rate === null ? 2 : sign * mesh.rate;
    const sorted = sign && rated ? [...cards].sort((a, b) => rank(a) - rank(b)) : cards;
    $('grid').replaceChildren(...sorted.map(c => c.item));
    redrawAll();
  };
  $('order').onchange = order;
  order();
}
function showModes(group) {
  const truth = group.meshes.some(mesh => mesh.truth);
  const known = { confidence: true, entropy: group.meshes.some(mesh => mesh.hasEntropy), border: group.meshes.some(mesh => mesh.hasBorder) };
  const available = Object.keys(MODES).filter(mode => known[mode] ?? (truth || mode === 'predicted'));
  if (!available.includes(state.mode)) state.mode = available[0];
  $('modes').replaceChildren(...available.map(mode => {
    const input = element('input', { type: 'radio', name: 'mode', value: mode, onchange: () => setMode(mode) });
    input.checked = mode === state.mode;
    return element('label', {}, input, element('span', { text: MODES[mode] }));
  }));
}
function setMode(mode) {
  const other = (mode === 'compare') !== (state.mode === 'compare');
  state.mode = mode;
  state.highlight = -1;
  showLegend();
  if (other) {
    showMeshes(state.group);
    if (large.mesh) showLarge(large.mesh);
  }
  for (const view of allViews()) view.canvas.setAttribute('aria-label', viewLabel(view.mesh, view.fixedMode));
  redrawAll();
}
function labelEntry(label, l) {
  const toggle = () => {
    state.highlight = state.highlight === l ? -1 : l;
    [...$('legend').querySelectorAll('button')].forEach((b, i) => b.setAttribute('aria-pressed', i === state.highlight));
    redrawAll();
  };
  return element('button', { type: 'button', title: 'Show only this part', 'aria-pressed': state.highlight === l, onclick: toggle },
                 swatch(state.group.colors[l]), label);
}
function showLegend() {
  const { mode, group } = state, entries = [];
  const entry = (color, text) => entries.push(element('span', { class: 'entry' }, swatch(css(color)), text));
  const shades = SHADES[mode];
  if (shades) {
    const stops = SHADE.map(([v, ...rgb]) => `${css(rgb)} ${100 * v}%`).join(', ');
    entries.push(element('span', { class: 'scale entry' }, shades.dark, element('i', { style: { background: `linear-gradient(90deg, ${stops})` } }), shades.pale),
                 element('span', { class: 'soft', text: shades.what }));
  }
  if (mode === 'compare' || mode === 'predicted' || mode === 'truth') entries.push(...group.labels.map(labelEntry));
  if (mode === 'compare' || mode === 'errors') {
    entry(RIGHT, 'right');
    entry(WRONG, 'wrong');
  }
  if (group.meshes.some(mesh => mesh.unlabeled) && mode !== 'predicted' && !shades) entry(UNKNOWN, 'no ground truth');
  if (mode === 'errors') entries.push(element('span', { class: 'soft', text: 'Lines: boundaries of the ground truth' }));
  $('legend').replaceChildren(...entries);
}

// ---- the enlarged view

function showLarge(mesh) {
  forget(large.views);
  const { views, parts } = viewsOf(mesh, $('large-detail'), true);
  Object.assign(large, { mesh, views });
  $('large-views').replaceChildren(...parts);
  $('large-name').textContent = mesh.rate === null ? mesh.name : `${mesh.name} — ${percent(mesh.rate)}`;
  requestDraw();
}
function openLarge(mesh) {
  showLarge(mesh);
  if (!$('large').open) {
    $('large-tools').append($('modes'), $('legend'));
    $('large').showModal();
  }
  large.views[0].canvas.focus();
}
function closeLarge() {
  forget(large.views);
  Object.assign(large, { mesh: null, views: [] });
  document.querySelector('.controls').prepend($('modes'));
  document.querySelector('.controls').after($('legend'));
}
function stepLarge(by) {
  const shown = [...new Set([...$('grid').querySelectorAll('canvas')].map(canvas => canvas.view.mesh))];
  openLarge(shown[(shown.indexOf(large.mesh) + by + shown.length) % shown.length]);
}

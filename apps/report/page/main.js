// ---- groups

function prepareGroup(group, g) {
  group.rgb = group.colors.map(hexColor);
  group.meshes = group.meshes.map((m, i) => new Mesh(m, group, `mesh-${g}-${i}`));
}
function showGroup(g) {
  const group = report.groups[g], alone = report.groups.length === 1;
  if (state.group && renderer.gl) for (const mesh of state.group.meshes) renderer.release(mesh);
  state.group = group;
  state.highlight = -1;
  [...$('groups').children].forEach((b, i) => b.setAttribute('aria-current', i === g));
  $('group-title').hidden = !group.title || (alone && group.title === report.title);
  $('group-title').textContent = group.title;
  $('subtitle').textContent = alone ? group.subtitle : '';
  $('group-subtitle').hidden = alone || !group.subtitle;
  $('group-subtitle').textContent = group.subtitle;
  showFigures(group);
  showModes(group);
  showLegend();
  showMeshes(group);
  showTables(group);
}
function groupFromAddress() {
  const g = Number(location.hash.replace('#group-', '')) - 1;
  return Number.isInteger(g) && g >= 0 && g < report.groups.length ? g : 0;
}
function start() {
  $('title').textContent = report.title;
  $('no-webgl').hidden = Boolean(renderer.gl);
  document.querySelector('.toolbar').hidden = !renderer.gl;
  report.groups.forEach(prepareGroup);
  if (report.groups.length > 1) $('overview').replaceChildren(...overviewPanel(report.groups));
  $('groups').hidden = report.groups.length < 2;
  $('groups').append(...report.groups.map((group, g) => element('button', { type: 'button', onclick: () => { location.hash = `#group-${g + 1}`; } },
    groupName(group, g), ...(group.rate === null ? [] : [element('span', { text: percent(group.rate), title: 'Recognition rate' })]))));
  $('order').append(...[['worst', 'worst first'], ['best', 'best first'], ['given', 'as given']].map(([value, text]) => element('option', { value, text })));
  $('linked').addEventListener('change', event => { state.linked = event.target.checked; });
  $('large-close').addEventListener('click', () => $('large').close());
  $('large-previous').addEventListener('click', () => stepLarge(-1));
  $('large-next').addEventListener('click', () => stepLarge(1));
  $('large').addEventListener('close', closeLarge);
  window.addEventListener('hashchange', () => showGroup(groupFromAddress()));
  showGroup(groupFromAddress());
}
start();

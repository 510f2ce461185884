// What all parts of the script share. The parts (see CMakeLists.txt) are one function's body, in order.

const report = JSON.parse(document.getElementById('report').textContent);
const UNLABELED = 255;
const NEUTRAL = [205, 210, 218];
// Errors differ in lightness as well as in hue, so they stand out whatever colors the reader tells apart.
const RIGHT = [206, 219, 236];
const WRONG = [203, 79, 0];
const UNKNOWN = [146, 150, 158];
// From 0 (dark, stands out) to 1 (pale), as stops of [value, red, green, blue].
const SHADE = [[0, 72, 14, 72], [.35, 168, 40, 88], [.6, 232, 106, 66], [.8, 249, 190, 108], [1, 231, 238, 240]];
const MODES = { compare: 'Side by side', predicted: 'Prediction', truth: 'Ground truth', errors: 'Errors', confidence: 'Confidence', entropy: 'Uncertainty', border: 'Borders' };
// Modes that shade faces by a number from 0 to 1: which number is dark, what both ends mean, and what the number is.
const SHADES = {
  confidence: { darkest: 0, dark: 'unsure, 0%', pale: '100%, sure', what: 'Probability of the predicted label' },
  entropy: { darkest: 1, dark: 'unsure, 1', pale: '0, sure', what: 'Entropy of the probabilities of all labels, 1 if they are equal' },
  border: { darkest: 1, dark: 'border, 100%', pale: '0%', what: 'Largest probability of a border at an edge of the face' },
};
const COMPARED = ['predicted', 'truth', 'errors'];
const state = { group: null, mode: 'compare', highlight: -1, linked: false, views: [] };

// ---- small helpers

const $ = id => document.getElementById(id);
/** An element with attributes (class, text, style object, on* listeners) and children; text never becomes markup. */
function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null) continue;
    if (key === 'text') node.textContent = value;
    else if (key === 'style') Object.assign(node.style, value);
    else if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}
const css = color => `rgb(${color.map(Math.round).join(' ')})`;
const swatch = color => element('span', { class: 'swatch', style: { background: color }, 'aria-hidden': 'true' });
const hexColor = text => [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16));
const percent = (share, digits = 1) => (100 * share).toFixed(digits) + '%';
const count = n => n.toLocaleString('en');
function duration(seconds) {
  if (seconds === null) return '–';
  if (seconds < 1e-3) return (seconds * 1e6).toFixed(0) + ' µs';
  if (seconds < 1) return (seconds * 1e3).toPrecision(3).replace(/\.$/, '') + ' ms';
  if (seconds < 100) return seconds.toPrecision(3) + ' s';
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ${String(Math.round(seconds % 60)).padStart(2, '0')} s`;
  return `${Math.floor(seconds / 3600)} h ${String(Math.floor(seconds / 60) % 60).padStart(2, '0')} min`;
}
function shadeColor(value) {
  let i = 1;
  while (i < SHADE.length - 1 && value > SHADE[i][0]) ++i;
  const a = SHADE[i - 1], b = SHADE[i], t = (value - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map(c => a[c] + t * (b[c] - a[c]));
}
const SVG = $('enlarge-icon').content.firstChild.namespaceURI;
/** An SVG element with attributes and children; `text` becomes its text. */
function drawn(tag, attributes = {}, ...children) {
  const node = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'text') node.textContent = value;
    else node.setAttribute(key, value);
  }
  node.append(...children);
  return node;
}

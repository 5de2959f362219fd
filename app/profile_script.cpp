// What the page of a profile does: it draws the bars, sorts the table, and tells about the pass that is chosen.

namespace firn::app {

extern const char* const profile_script;
const char* const profile_script = R"SCRIPT(
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const colors = data.passes.map((pass, i) => `hsl(${Math.round(i * 137.5) % 360} ${52 - i % 3 * 8}% ${i % 2 ? 62 : 50}%)`);
const node = id => document.getElementById(id);
const text = (tag, content, name) => {
  const element = document.createElement(tag);
  element.textContent = content;
  if (name) element.className = name;
  return element;
};
const svg = (parent, tag, attributes, content) => {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (content !== undefined) element.textContent = content;
  parent.append(element);
  return element;
};
const time = seconds => seconds >= 1 ? seconds.toFixed(2) + ' s' : seconds >= 1e-3 ? (1e3 * seconds).toFixed(2) + ' ms'
                                                                              : (1e6 * seconds).toFixed(1) + ' \u00b5s';
const size = bytes => bytes >= 1e9 ? (1e-9 * bytes).toFixed(2) + ' GB' : bytes >= 1e6 ? (1e-6 * bytes).toFixed(2) + ' MB'
                    : bytes >= 1e3 ? (1e-3 * bytes).toFixed(2) + ' kB' : bytes.toFixed(0) + ' B';
const rate = value => value >= 1e12 ? (1e-12 * value).toFixed(2) + ' TB/s' : (1e-9 * value).toFixed(2) + ' GB/s';
const percent = share => (100 * share).toFixed(1) + ' %';
const of_copy = pass => data.speed.copy > 0 ? pass.rate / data.speed.copy : 0;
const of_bound = pass => `${pass.at_most ? '\u2264 ' : ''}${percent(pass.bound)} ${pass.by}`;
const known = pass => pass.bound >= 0;  // its bytes
// "mpm/sort_count.comp" is sort_count; where that says no more than the stage's own name, the stage alone.
const short = pass => pass.work.replace(/^.*\//, '').replace(/\.comp$/, '');
const name_of = pass => pass.stage.replace(/#.*/, '').endsWith('.' + short(pass)) ? pass.stage : pass.stage + ' \u00b7 ' + short(pass);

// --- head
node('title').textContent = data.pipeline + ' on ' + data.scene;
document.title = 'Profile of ' + data.pipeline;
node('where').textContent = `${data.device}; times by ${data.clock}`;
const fact = (value, meaning) => {
  const box = text('div', '', 'fact');
  box.append(text('b', value), text('span', meaning));
  node('facts').append(box);
};
fact(time(data.wall), 'a step by the clock on the wall');
fact(time(data.total / data.steps), `a step in its passes, mean of ${data.steps}`);
if (data.cost !== null) fact((100 * data.cost).toFixed(1) + ' %', 'what timing adds to a step');
fact(rate(data.speed.copy), 'the device copies, read and written');
fact((1e-9 * data.speed.multiply_add).toFixed(0) + ' GFLOP/s', 'it multiplies and adds');
fact(time(data.speed.launch), 'from launch to launch');

// --- tips
const tip = node('tip');
const say = (element, lines) => {
  element.addEventListener('mousemove', event => {
    tip.textContent = '';
    for (const line of lines) tip.append(text('div', line));
    tip.style.display = 'block';
    tip.style.left = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8) + 'px';
    tip.style.top = Math.min(event.clientY + 16, innerHeight - tip.offsetHeight - 8) + 'px';
  });
  element.addEventListener('mouseleave', () => { tip.style.display = 'none'; });
};

// --- one bar of a pass anywhere: hover shows it everywhere, a click opens its details
let chosen = -1;
const highlight = pass => {
  for (const bar of document.querySelectorAll('.bar')) bar.classList.toggle('dim', pass >= 0 && +bar.dataset.pass !== pass);
  for (const row of document.querySelectorAll('#passes tbody tr')) row.classList.toggle('hover', +row.dataset.pass === pass);
};
const hoverable = (element, pass) => {
  element.addEventListener('mouseenter', () => highlight(pass));
  element.addEventListener('mouseleave', () => highlight(-1));
};

// --- all steps
const steps = [];
for (const [pass, step, start, seconds] of data.launches) (steps[step] = steps[step] || []).push({pass, start, seconds});
let shown = 0;
if (steps.length < data.steps)
  node('shown').textContent = `The first ${steps.length} of ${data.steps} steps are drawn; the table counts all. `;
const draw_steps = () => {
  const picture = node('steps'), width = picture.clientWidth, height = 190, left = 62, bottom = 22, top = 10;
  picture.textContent = '';
  picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const sums = steps.map(step => step.reduce((sum, bar) => sum + bar.seconds, 0));
  // One step that something else disturbed must not flatten all others.
  const sorted = [...sums].sort((a, b) => a - b), most = Math.min(sorted[sorted.length - 1], 2 * sorted[sorted.length >> 1]) || 1e-9;
  const x = (width - left - 8) / steps.length, y = (height - bottom - top) / most;
  for (let i = 0; i <= 4; ++i) {
    const at = height - bottom - i / 4 * most * y;
    svg(picture, 'line', {x1: left, x2: width - 8, y1: at, y2: at, stroke: '#dfe5eb'});
    svg(picture, 'text', {x: left - 6, y: at + 4, 'text-anchor': 'end'}, time(i / 4 * most));
  }
  const every = Math.max(1, Math.ceil(steps.length / 10));
  steps.forEach((step, i) => {
    // Launches of one pass in one step are one bar here.
    const parts = new Map();
    for (const bar of step) parts.set(bar.pass, (parts.get(bar.pass) || 0) + bar.seconds);
    let floor = 0;
    for (const [pass, seconds] of parts) {
      const ceiling = Math.min(most, floor + seconds);
      const bar = svg(picture, 'rect', {class: 'bar', x: left + i * x, width: Math.max(.5, x - (x > 4 ? 1 : 0)),
                                        y: height - bottom - ceiling * y, height: Math.max(0, (ceiling - floor) * y), fill: colors[pass]});
      bar.dataset.pass = pass;
      hoverable(bar, pass);
      say(bar, [name_of(data.passes[pass]), `${time(seconds)} of ${time(sums[i])} in step ${i}`]);
      bar.addEventListener('click', () => { show_step(i); choose(pass); });
      floor = ceiling;
    }
    if (i % every === 0) svg(picture, 'text', {x: left + (i + .5) * x, y: height - 6, 'text-anchor': 'middle'}, i);
    if (i === shown) svg(picture, 'rect', {x: left + i * x - .5, width: Math.max(2, x), y: height - bottom, height: 3, fill: '#1d2733'});
  });
};

// --- one step over time, a row for every pass
const draw_step = () => {
  const picture = node('step'), width = picture.clientWidth, bars = steps[shown] || [];
  const rows = [...new Set(bars.map(bar => bar.pass))], row = 19, left = 300, top = 8, bottom = 22;
  const height = top + rows.length * row + bottom;
  picture.textContent = '';
  picture.setAttribute('height', height);
  picture.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const first = Math.min(...bars.map(bar => bar.start)), last = Math.max(...bars.map(bar => bar.start + bar.seconds));
  const scale = (width - left - 14) / Math.max(last - first, 1e-9);
  node('step-title').textContent = `Step ${shown} over time: ${time(last - first)}`;
  for (let i = 0; i <= 5; ++i) {
    const at = left + i / 5 * (width - left - 14);
    svg(picture, 'line', {x1: at, x2: at, y1: top, y2: height - bottom, stroke: '#dfe5eb'});
    svg(picture, 'text', {x: at, y: height - 6, 'text-anchor': i === 5 ? 'end' : 'middle'}, time(i / 5 * (last - first)));
  }
  rows.forEach((pass, i) => {
    const name = name_of(data.passes[pass]);
    svg(picture, 'text', {x: left - 8, y: top + i * row + 14, 'text-anchor': 'end'}, name.length > 46 ? '\u2026' + name.slice(-45) : name);
  });
  for (const {pass, start, seconds} of bars) {
    const bar = svg(picture, 'rect', {class: 'bar', x: left + (start - first) * scale, width: Math.max(1, seconds * scale),
                                      y: top + rows.indexOf(pass) * row + 3, height: row - 5, rx: 1.5, fill: colors[pass]});
    bar.dataset.pass = pass;
    hoverable(bar, pass);
    say(bar, [name_of(data.passes[pass]), `${time(seconds)}, from ${time(start - first)}`]);
    bar.addEventListener('click', () => choose(pass));
  }
};
const show_step = step => { shown = step; draw_steps(); draw_step(); };

// --- the table
const columns = [
  ['stage', pass => pass.stage, value => value, false], ['work', short, value => value, false],
  ['per step', pass => pass.launches / data.steps, value => value.toFixed(2), true],
  ['median', pass => pass.median, time, true], ['p90', pass => pass.p90, time, true],
  ['share', pass => pass.share, percent, true],
  ['bytes', pass => known(pass) ? pass.bytes : -1, value => value < 0 ? '\u2013' : size(value), true],
  ['bandwidth', pass => known(pass) ? pass.rate : -1, value => value < 0 ? '\u2013' : rate(value), true],
  ['of bound', pass => pass.bound, (value, pass) => value < 0 ? '\u2013' : of_bound(pass), true],
  ['held back by', pass => pass.held, value => value, false]];
let sorted_by = -1, falling = true;
const draw_table = () => {
  const head = document.querySelector('#passes thead tr'), body = document.querySelector('#passes tbody');
  head.textContent = body.textContent = '';
  columns.forEach(([name, , , number], i) => {
    const cell = text('th', name + (i === sorted_by ? falling ? ' \u2193' : ' \u2191' : ''), number ? 'n' : '');
    cell.addEventListener('click', () => {
      if (sorted_by === i) falling = !falling; else { sorted_by = i; falling = number; }
      draw_table();
    });
    head.append(cell);
  });
  const order = data.passes.map((pass, i) => i);
  if (sorted_by >= 0) {
    const value = columns[sorted_by][1];
    const compare = (a, b) => a < b ? -1 : a > b ? 1 : 0;
    order.sort((a, b) => (falling ? -1 : 1) * compare(value(data.passes[a]), value(data.passes[b])));
  }
  for (const i of order) {
    const pass = data.passes[i], row = text('tr', '', i === chosen ? 'chosen' : '');
    row.dataset.pass = i;
    columns.forEach(([name, value, show, number], column) => {
      const cell = text('td', show(value(pass), pass), number ? 'n' : '');
      if (column === 0) {
        const swatch = text('span', '', 'swatch');
        swatch.style.background = colors[i];
        cell.prepend(swatch);
      }
      if (name === 'share' || name === 'of bound' && known(pass)) {
        const meter = text('span', '', 'meter'), fill = text('i', '');
        fill.style.width = Math.min(100, 100 * value(pass)) + '%';
        meter.append(fill);
        cell.append(meter);
      }
      row.append(cell);
    });
    hoverable(row, i);
    row.addEventListener('click', () => choose(i));
    body.append(row);
  }
};

// --- details of one pass
const draw_details = () => {
  const box = node('details'), pass = data.passes[chosen];
  box.textContent = '';
  box.append(text('h3', name_of(pass)), text('p', pass.doc + (pass.equation ? '  ' + pass.equation : '')));
  if (pass.left_out) {
    box.append(text('p', `Left out: ${pass.left_out}.`));
    return;
  }
  box.append(text('p', `${pass.launches} launches in ${data.steps} steps, ${pass.elements}. Median ${time(pass.median)}, nine of ten ` +
                       `below ${time(pass.p90)}, ${percent(pass.total / data.total)} of the time of a step.`));
  box.append(text('p', `Held back by ${pass.held}: ${pass.why}.`));
  if (known(pass))
    box.append(text('p', `Of the device's rate of copying: ${pass.at_most ? 'at most ' : ''}${percent(of_copy(pass))}` +
                         (pass.maths >= 0 ? `; of its rate of arithmetic: ${percent(pass.maths)}` : '') + '.'));
  const picture = svg(box, 'svg', {height: 90, id: 'history'}), width = picture.clientWidth || 1180;
  picture.setAttribute('viewBox', `0 0 ${width} 90`);
  const times = data.launches.filter(launch => launch[0] === chosen).map(launch => launch[3]);
  const most = Math.min(Math.max(...times), 3 * pass.median) || 1e-9, step = (width - 80) / times.length;
  svg(picture, 'text', {x: 66, y: 16, 'text-anchor': 'end'}, time(most));
  svg(picture, 'text', {x: 66, y: 82, 'text-anchor': 'end'}, '0');
  times.forEach((seconds, i) => {
    const height = 72 * Math.min(1, seconds / most);
    svg(picture, 'rect', {x: 72 + i * step, width: Math.max(.6, step - (step > 3 ? 1 : 0)), y: 82 - height, height, fill: colors[chosen]});
  });
  if (pass.host || !pass.traffic.length) return;
  if (short(pass) !== pass.work) box.append(text('p', 'Kernel: ' + pass.work, 'pale'));
  const table = text('table', ''), head = text('tr', '');
  for (const [name, number] of [['buffer', 0], ['access', 0], ['usage', 0], ['read', 1], ['written', 1]])
    head.append(text('th', name, number ? 'n' : ''));
  table.append(head);
  for (const [buffer, access, usage, read, written, at_most] of pass.traffic) {
    const most = bytes => (at_most && bytes > 0 ? '\u2264 ' : '') + size(bytes);
    const row = text('tr', '');
    row.append(text('td', buffer), text('td', access), text('td', usage), text('td', most(read), 'n'), text('td', most(written), 'n'));
    table.append(row);
  }
  box.append(table);
};
const choose = pass => {
  chosen = pass;
  draw_table();
  draw_details();
};

const longest = data.passes.reduce((best, pass, i) => pass.total > data.passes[best].total ? i : best, 0);
show_step(0);
choose(longest);
addEventListener('resize', () => { show_step(shown); draw_details(); });
)SCRIPT";

}  // namespace firn::app

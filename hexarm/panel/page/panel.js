'use strict';
// The controls. The server answers each question with the newest state, so that a slow page is not flooded; what the
// page shows is what the server says, also on two pages at once. Metres and radians on the line, mm and ° on the page.
const POLL_MS = 100, SILENT_MS = 2500, REPORTED_MS = 2500, OLD_MS = 8000, HAND_MS = 1500, AGAIN_MS = 1000, REPEAT_MS = 250;
const MM = 1e3, DEG = 180 / Math.PI;
const $ = (id) => document.getElementById(id);
const make = (tag, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), attributes);
  made.append(...children);
  return made;
};

let socket = null, machine = null, state = null, askedAt = 0, answeredAt = 0, nodesAt = 0, tab = 'drive';
let reason = '', reasonAt = 0, toolAt = 0;

// Line

function send(words) {
  if (!socket || socket.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(words));
  return true;
}

function connect() {
  const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
  socket = new WebSocket(`${scheme}://${location.host}/controls`);
  socket.onmessage = (event) => {
    const words = JSON.parse(event.data);
    if (words.machine) begin(words.machine);
    if (words.state) { askedAt = 0; answeredAt = Date.now(); show(words.state); }
    if (words.nodes) showNodes(words.nodes);
  };
  socket.onclose = () => { show(LOST); setTimeout(connect, 1000); };
}

const LOST = { state: 'none', reason: '', notice: '', motion: '', can: [],
  step: { text: 'No connection to the panel. Does hexarm up run? The page connects again by itself.', action: null } };

setInterval(() => {
  const now = Date.now();
  if (askedAt && now - askedAt > SILENT_MS) { show(LOST); askedAt = 0; }   // asks again: a question may be lost
  if (!askedAt && machine && send({ want: 'state' })) askedAt = now;
  if (tab === 'nodes' && now - nodesAt > 1000 && send({ want: 'nodes' })) nodesAt = now;
}, POLL_MS);

// STOP

let stopTimer = null;
function stop() {
  const isSent = send({ do: 'stop' });
  $('stop').classList.toggle('unsent', !isSent);
  $('stop').textContent = isSent ? 'STOP' : 'STOP NOT SENT: switch the supply off';
}
$('stop').addEventListener('pointerdown', (event) => {
  if (event.button !== 0) return;
  stop();   // on press, not on release
  clearInterval(stopTimer);
  stopTimer = setInterval(stop, AGAIN_MS);
});
for (const end of ['pointerup', 'pointercancel', 'pointerleave']) {
  $('stop').addEventListener(end, () => clearInterval(stopTimer));
}
$('stop').addEventListener('keydown', (event) => { if (event.key === 'Enter' || event.key === ' ') stop(); });

// Sliders: a row shows what the server says, unless a hand has just moved it.

class Row {
  constructor(label, low, high, step, factor, request) {
    Object.assign(this, { factor, request, step, movedAt: 0, target: null });
    this.range = make('input', { type: 'range', min: low * factor, max: high * factor, step, ariaLabel: label });
    this.number = make('input', { type: 'number', min: low * factor, max: high * factor, step, ariaLabel: label });
    this.number.inputMode = 'decimal';
    this.reach = make('i');
    this.track = make('div', { className: 'track' }, this.reach, this.range);
    this.element = make('div', {}, make('label', { textContent: label, title: label }), this.track, this.number);
    this.range.addEventListener('input', () => this.moved(+this.range.value));
    this.number.addEventListener('change', () => { this.number.blur(); this.moved(+this.number.value); });
  }

  withKeys(size) {
    for (const [sign, text] of [[-1, '−'], [1, '+']]) {
      const key = make('button', { textContent: text, ariaLabel: `${this.range.ariaLabel} ${text}` });
      let timer = null;
      const push = () => this.moved(Math.min(+this.range.max, Math.max(+this.range.min, this.target + sign * size())));
      key.addEventListener('pointerdown', () => { clearInterval(timer); push(); timer = setInterval(push, REPEAT_MS); });
      for (const end of ['pointerup', 'pointercancel', 'pointerleave', 'blur']) {
        key.addEventListener(end, () => clearInterval(timer));
      }
      key.addEventListener('keydown', (event) => { if (event.key === 'Enter' || event.key === ' ') push(); });
      this.track.insertAdjacentElement(sign < 0 ? 'beforebegin' : 'afterend', key);
    }
    return this;
  }

  moved(value) {
    if (!Number.isFinite(value)) return;
    this.movedAt = Date.now();
    this.put(value);
    this.request(value / this.factor);
  }

  put(value) {
    this.target = value;
    this.range.value = value;
    if (document.activeElement !== this.number) this.number.value = value.toFixed(this.step < 1 ? 1 : 0);
  }

  follow(value) {
    if (value !== null && Date.now() - this.movedAt > HAND_MS) this.put(value * this.factor);
  }

  mark(low, high) {
    const share = (v) => 100 * (v * this.factor - this.range.min) / (this.range.max - this.range.min);
    const from = Math.max(0, share(low)), to = Math.min(100, share(high));
    Object.assign(this.reach.style, { left: `${from}%`, width: `${Math.max(0, to - from)}%` });
    this.track.title = `alone from ${(low * this.factor).toFixed(1)} to ${(high * this.factor).toFixed(1)}`;
  }

  enable(is) { for (const part of this.element.querySelectorAll('input, button')) part.disabled = !is; }
}

// The machine, once for each connection

const AXES = ['x [mm]', 'y [mm]', 'z [mm]', 'roll [°]', 'pitch [°]', 'yaw [°]'];
const FACTORS = [MM, MM, MM, DEG, DEG, DEG];
let goal = [], joints = [], speed = null, gripper = null, jointsPlot = null, errorsPlot = null, factor = 1;

function begin(words) {
  machine = words;
  askedAt = 0;
  $('machine').textContent = words.label;
  if (!$('scene').src) $('scene').src = `index.html${location.search}`;
  goal = AXES.map((name, k) => new Row(name, ...words.bounds[k], 0.1, FACTORS[k],
    (value) => send({ do: 'goal', axis: k, value })));
  $('goal').replaceChildren(...goal.map((row) => row.element));
  speed = new Row('speed [%]', 0, 1, 1, 100, (value) => send({ do: 'speed', value }));
  const rows = [speed];
  gripper = words.has_gripper ? new Row('gripper [%]', 0, 1, 1, 100, (value) => send({ do: 'grip', value })) : null;
  if (gripper) rows.push(gripper);
  $('shares').replaceChildren(...rows.map((row) => row.element));
  const isAngle = words.joint_unit === 'rad', unit = isAngle ? '°' : 'mm';
  factor = isAngle ? DEG : MM;
  joints = words.joints.map((joint) => new Row(joint.name, joint.low, joint.high, 0.1, factor,
    (value) => send({ do: 'joint', name: joint.name, value })).withKeys(() => +$('stepsize').value));
  $('joint-sliders').className = 'sliders steps';
  $('joint-sliders').replaceChildren(...joints.map((row) => row.element));
  $('stepsize').replaceChildren(...[0.1, 1, 5, 10].map((v) => make('option', { value: v, textContent: `${v} ${unit}`, selected: v === 1 })));
  $('mode').replaceChildren(...words.modes.map((mode) => make('option', { textContent: mode })));
  $('tools').hidden = !words.tools.length;
  $('tool').replaceChildren(...['', ...words.tools].map((tool) => make('option', { value: tool, textContent: tool || 'none' })));
  $('joints-title').textContent = `Joints [${unit}]`;
  $('legend').replaceChildren(...words.joints.map((joint, k) => {
    const name = make('span', { textContent: joint.name });
    name.style.color = COLOURS[k % COLOURS.length];
    return name;
  }));
  jointsPlot = new Plot($('plot-joints'), words.joints.map((_, k) => COLOURS[k % COLOURS.length]));
  errorsPlot = new Plot($('plot-errors'), ['#58a6ff', '#f5b041']);
}

$('scene').addEventListener('load', () => {
  // Of viser's page only the canvas: its own panel is replaced by this one.
  const style = $('scene').contentDocument.createElement('style');
  style.textContent = 'body { background: #0d1117 } body * { visibility: hidden } canvas { visibility: visible !important }';
  $('scene').contentDocument.head.append(style);
});

// What the machine is, many times a second

function show(words) {
  state = words;
  const can = new Set(words.can);
  $('state').textContent = words.state === 'none' ? 'no connection' : words.state;
  $('state').className = words.state;
  document.title = machine ? `${machine.label}: ${$('state').textContent}` : 'hexarm';
  showReason([words.reason, words.notice, words.motion].filter(Boolean).join(' · '));
  $('step').hidden = !words.step.text;
  $('measured').hidden = Boolean(words.step.text);
  $('step').firstElementChild.textContent = words.step.text;
  $('next').hidden = !words.step.action;
  $('next').textContent = words.step.action ? document.querySelector(`[data-do=${words.step.action}]`).textContent : '';
  for (const button of document.querySelectorAll('[data-do]')) {
    button.disabled = !can.has(button.dataset.do) && button.dataset.do !== 'clear_trail';
  }
  for (const row of [...goal, ...joints]) row.enable(can.has('goal'));
  if (gripper) gripper.enable(can.has('goal'));
  if (!('goal' in words)) return;
  goal.forEach((row, k) => { row.follow(words.goal[k]); if (words.ranges) row.mark(...words.ranges[k]); });
  joints.forEach((row, k) => row.follow(words.joint_goal ? words.joint_goal[k] : null));
  speed.follow(words.speed);
  if (gripper) gripper.follow(words.opening);
  if (Date.now() - toolAt > REPORTED_MS && $('tool').value !== words.tool) $('tool').value = words.tool;
  if ($('reach').textContent !== words.reach) $('reach').textContent = words.reach;
  showMeasured(words);
  showSaved(words.saved, can);
  if (!words.joints) return;
  const now = Date.now() / 1000;
  jointsPlot.note(now, words.joints.map((value) => value * factor));
  errorsPlot.note(now, words.errors ? [words.errors[0] * MM, words.errors[1] * DEG] : [NaN, NaN]);
  if (tab === 'plots') { jointsPlot.draw(); errorsPlot.draw(); }
}

function showReason(text) {
  if (text !== reason) { reason = text; reasonAt = Date.now(); $('reason').textContent = text; $('reason').title = text; }
  $('reason').classList.toggle('old', Date.now() - reasonAt > OLD_MS && state.state === 'enabled');
}

function showMeasured(words) {
  const number = (k) => (words.pose[k] * FACTORS[k]).toFixed(2).padStart(8);
  const text = words.pose
    ? `x${number(0)}   y${number(1)}   z${number(2)} mm\nr${number(3)}   p${number(4)}   y${number(5)} °`
    : 'The pose is not known: not all joints are.';
  if ($('measured').textContent !== text) $('measured').textContent = text;
}

function showSaved(names, can) {
  const text = JSON.stringify([names, can.has('go_to')]);
  if ($('saved').dataset.text === text) return;
  $('saved').dataset.text = text;
  $('saved').replaceChildren(...names.map((name) => {
    const go = make('button', { textContent: 'Go', disabled: !can.has('go_to'), ariaLabel: `go to ${name}` });
    go.addEventListener('click', () => send({ do: 'go_to', name }));
    const remove = make('button', { textContent: 'Delete', ariaLabel: `delete ${name}` });
    remove.addEventListener('click', () => {
      if (remove.textContent === 'Delete') { remove.textContent = 'Sure?'; setTimeout(() => { remove.textContent = 'Delete'; }, 3000); }
      else send({ do: 'delete', name });
    });
    return make('li', {}, make('span', { textContent: name }), go, remove);
  }));
  if (!names.length) $('saved').append(make('li', { textContent: 'No pose is saved yet.' }));
}

const SIGNS = [['✓', 'green'], ['⚠', 'amber'], ['✗', 'red'], ['✗', 'red']];
function showNodes(nodes) {
  $('nodes').replaceChildren(...nodes.map(({ name, level, message, values }) => {
    const [sign, colour] = SIGNS[Math.min(Math.max(level, 0), 3)];
    const caption = make('caption', {}, make('span', { textContent: `${sign} `, className: colour }), `${name}: ${message}`);
    const rows = Object.entries(values).filter(([, value]) => value !== '').map(([key, value]) =>
      make('tr', {}, make('td', { textContent: key.replaceAll('_', ' ') }), make('td', { textContent: value })));
    return make('table', {}, caption, ...rows);
  }));
  if (!nodes.length) $('nodes').append(make('p', { textContent: 'No node has reported yet.' }));
}

// What hands do

for (const button of document.querySelectorAll('[data-do]')) {
  if (button.dataset.do !== 'save') button.addEventListener('click', () => send({ do: button.dataset.do }));
}
$('next').addEventListener('click', () => { if (state && state.step.action) send({ do: state.step.action }); });
$('save').addEventListener('submit', (event) => {
  event.preventDefault();
  if (send({ do: 'save', name: $('name').value.trim() })) $('name').value = '';
});
$('mode').addEventListener('change', () => send({ do: 'mode', name: $('mode').value }));
$('tool').addEventListener('change', () => {
  toolAt = Date.now();   // it is reported once a second, and changed once the machine is at rest
  send({ do: 'tool', name: $('tool').value });
});
$('share').addEventListener('input', () => {
  $('share').nextElementSibling.textContent = `${$('share').value} %`;
  send({ do: 'share', value: $('share').value / 100 });
});
$('reach-shown').addEventListener('change', () => send({ do: 'show_reach', value: $('reach-shown').checked ? 1 : 0 }));
$('fold').addEventListener('click', () => {
  const isFolded = document.body.classList.toggle('folded');
  $('fold').setAttribute('aria-expanded', String(!isFolded));
});
for (const button of document.querySelectorAll('[role=tab]')) {
  button.addEventListener('click', () => {
    tab = button.dataset.tab;
    for (const other of document.querySelectorAll('[role=tab]')) other.setAttribute('aria-selected', String(other === button));
    for (const section of document.querySelectorAll('main > section')) section.hidden = section.id !== tab;
    document.body.classList.remove('folded');
    nodesAt = 0;
    if (tab === 'plots' && jointsPlot) { jointsPlot.draw(); errorsPlot.draw(); }
  });
}
connect();

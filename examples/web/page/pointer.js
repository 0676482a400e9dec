// Dragging the picture, the lamp and the bar by mouse, touch and keyboard.

/** A key's step, in heights of the picture, and of the bar in parts of the width. */
const STEP = 0.03;

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * `moved(x, y, event)` is called with each step of a drag, in pixels of the page, and with arrow keys;
 * `pinched(ratio)` with two fingers' distance over what it was.
 */
function draggable(element, moved, pinched) {
  const pointers = new Map();
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  element.addEventListener('pointerdown', (event) => {
    event.stopPropagation();
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  element.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const [x, y] = [event.clientX - last.x, event.clientY - last.y];
    if (pointers.size === 2 && pinched) {
      const before = spread();
      Object.assign(last, { x: event.clientX, y: event.clientY });
      if (before > 0) pinched(spread() / before);
      return;
    }
    Object.assign(last, { x: event.clientX, y: event.clientY });
    if (pointers.size === 1) moved(x, y, event);
  });
  const gone = (event) => pointers.delete(event.pointerId);
  element.addEventListener('pointerup', gone);
  element.addEventListener('pointercancel', gone);
  element.addEventListener('keydown', (event) => {
    const arrow = ARROWS[event.key];
    if (!arrow) return;
    event.preventDefault();
    const step = STEP * element.parentElement.clientHeight;
    moved(arrow[0] * step, arrow[1] * step, event);
  });
}

/**
 * Listens on the picture. `view` has `bar` (0 to 1), `dragsLight()`, and is told by `turn`, `advance` and
 * `light` in heights of the picture, and by `changed()` after each.
 */
export function listen(view) {
  const [stage, picture, bar, lamp] = ['stage', 'picture', 'bar', 'lamp']
    .map((id) => document.getElementById(id));
  const inHeights = (action) => (x, y, event) => {
    action(x / stage.clientHeight, y / stage.clientHeight, event);
    view.changed();
  };
  const secondary = (event) => event.shiftKey || (event.buttons & 2) !== 0;
  draggable(picture, inHeights((x, y, event) => {
    const light = view.dragsLight() !== secondary(event);
    if (light) view.light(x, y);
    else view.turn(x, y);
  }), (ratio) => {
    view.advance(Math.log(ratio) / Math.log(1.1));
    view.changed();
  });
  draggable(lamp, inHeights((x, y) => view.light(x, y)));
  picture.addEventListener('contextmenu', (event) => event.preventDefault());
  picture.addEventListener('wheel', (event) => {
    event.preventDefault();
    const lines = event.deltaY / (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 3 : 100);
    view.advance(-lines);
    view.changed();
  }, { passive: false });

  draggable(bar, (x) => {
    view.bar = Math.min(1, Math.max(0, view.bar + x / stage.clientWidth));
    showBar(view.bar);
    view.changed();
  });
  for (const target of [picture, bar, lamp]) {
    target.addEventListener('pointerdown', () => { stage.dataset.state = 'touched'; });
  }
}

/** Puts the bar where it belongs. */
export function showBar(at) {
  const bar = document.getElementById('bar');
  bar.style.left = `${100 * at}%`;
  bar.setAttribute('aria-valuenow', Math.round(100 * at));
}

/** Puts the lamp where it is seen: in parts of the picture, or nowhere. */
export function showLamp([x, y]) {
  const lamp = document.getElementById('lamp');
  lamp.hidden = x === undefined;
  if (!lamp.hidden) Object.assign(lamp.style, { left: `${100 * x}%`, top: `${100 * y}%` });
}

// The controls, and the page's address, which says the same: a link shows what its sender saw.

/** Choices that Rust knows by the same names; `error` is shown over the visibility. */
const DEFAULTS = {
  scene: 'courtyard',
  light: 'point',
  left: 'textbook',
  right: 'map',
  kernel: 'bilinear',
  size: '512',
  normal: '',
  constant: '',
  show: 'picture',
  drag: 'camera',
  turn: '',
};

export class Controls {
  /** `changed(names)` is called with the names of what changed. */
  constructor(form, defaults, changed) {
    this.form = form;
    this.defaults = { ...DEFAULTS, ...defaults };
    this.values = { ...this.defaults };
    this.changed = changed;
    const address = new URLSearchParams(location.hash.slice(1));
    for (const [name, value] of address) this.#fill(name, value);
    this.#show();
    form.addEventListener('input', ({ target }) => this.#read(target));
    form.addEventListener('submit', (event) => event.preventDefault());
  }

  /** Takes over a value that a control can have; others are left alone. */
  #fill(name, value) {
    const control = this.form.elements[name];
    if (!(name in this.values) || !control) return;
    const known = control instanceof RadioNodeList
      ? [...control].some((radio) => radio.value === value)
      : control.type === 'range' ? Number.isFinite(parseFloat(value))
        : control.type === 'checkbox' || [...control.options].some((option) => option.value === value);
    if (known) this.values[name] = value;
  }

  /** Sets the controls to the values. */
  #show() {
    for (const [name, value] of Object.entries(this.values)) {
      const control = this.form.elements[name];
      if (control.type === 'checkbox') control.checked = value !== '';
      else control.value = value;
    }
    this.#consequences();
  }

  #read(target) {
    const { name, type, checked, value } = target;
    if (!(name in this.values)) return;
    this.values[name] = type === 'checkbox' ? (checked ? 'yes' : '') : value;
    const also = name === 'light' ? this.#suitLight() : [];
    this.#consequences();
    const others = Object.entries(this.values).filter(([name, value]) => value !== this.defaults[name]);
    history.replaceState(null, '', `#${new URLSearchParams(others)}`);
    this.changed([name, ...also]);
  }

  /** The map that suits the light: cascades under a sun. Gives the names of what changes. */
  #suitLight() {
    const { values, form } = this;
    const [suits, other] = values.light === 'sun' ? ['atlas', 'map'] : ['map', 'atlas'];
    if (values.right !== other) return [];
    form.elements.right.value = values.right = suits;
    return ['right'];
  }

  /** What other controls say of it. */
  #consequences() {
    const { elements } = this.form;
    const point = this.values.light === 'point';
    document.getElementById('map-name').textContent = point ? 'cube map' : 'flat map';
    document.getElementById('maps').inert = this.values.right === 'volumes';
    for (const name of ['normal', 'constant']) {
      elements[name].parentElement.querySelector('output').value = Number(elements[name].value).toFixed(2);
    }
    const three = [...elements.left.options].find((option) => option.value === 'three');
    three.disabled = !point;
    if (!point && this.values.left === 'three') {
      elements.left.value = this.values.left = 'textbook';
      this.changed?.(['left']);
    }
  }

  /** What both halves are called. */
  names() {
    const { left, right } = this.form.elements;
    const chosen = [...right].find((radio) => radio.checked);
    return [
      left.selectedOptions[0].textContent,
      `this crate: ${chosen.parentElement.textContent}`,
    ];
  }
}

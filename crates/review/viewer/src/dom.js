// Small pieces of page. Words are put on it as text, never as markup.

/** An element with attributes and children; a child that is no element becomes text. */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

/** The same of a drawing. */
export function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

let count = 0;

/** A box to tick with its label. */
export function tick(label, isOn, change, swatch = null) {
  const id = `tick-${++count}`;
  const box = make("input", { type: "checkbox", id, onchange: () => change(box.checked) });
  box.checked = isOn;
  return make("div", { class: "tick" }, box, make("label", { for: id }, swatch, make("span", {}, label)));
}

/** A slider with its label. */
export function slider(label, { min, max, step, value, words }, change) {
  const id = `slider-${++count}`;
  const input = make("input", { type: "range", id, min, max, step });
  input.value = value;
  const shown = make("output", { for: id }, words ? words(value) : "");
  const said = () => {
    if (!words) return;
    shown.textContent = words(Number(input.value));
    input.setAttribute("aria-valuetext", words(Number(input.value)));
  };
  input.addEventListener("input", () => {
    said();
    change(Number(input.value));
  });
  said();
  const set = (next) => {
    input.value = next;
    said();
  };
  return { element: make("div", { class: "slider" }, make("label", { for: id }, label), input, shown), input, set };
}

/** Buttons of which one is pressed. */
export function choice(label, entries, isOn, change) {
  const buttons = entries.map(([value, name]) => {
    const press = () => {
      set(value);
      change(value);
    };
    return [value, make("button", { type: "button", onclick: press }, name)];
  });
  const set = (value) => {
    for (const [own, button] of buttons) button.setAttribute("aria-pressed", String(own === value));
  };
  set(isOn);
  return { element: make("div", { class: "choice", role: "group", "aria-label": label }, ...buttons.map(([, b]) => b)), set };
}

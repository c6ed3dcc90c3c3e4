// Building the page. Text always goes in as text, so nothing in the data can become markup.
type Child = Node | string | null | undefined;
type Attributes = Record<string, string | number | null | undefined>;

export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes?: Attributes | null, ...children: Child[]): HTMLElementTagNameMap[K] {
  return fill(document.createElement(tag), attributes, children);
}

export function shape(tag: string, attributes?: Attributes | null, ...children: Child[]): SVGElement {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', tag) as SVGElement, attributes, children);
}

function fill<T extends Element>(node: T, attributes: Attributes | null | undefined, children: Child[]): T {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value !== undefined && value !== null) node.setAttribute(name, String(value));
  }
  for (const child of children) {
    if (child !== undefined && child !== null) node.append(child);
  }
  return node;
}

export function section(title: string, note: Child, ...children: Child[]): HTMLElement {
  return element('section', {}, element('h2', {}, title), note ? element('p', { class: 'note' }, note) : null, ...children);
}

/** A section that is closed until it is asked for; paper shows it open. */
export function folded(title: string, ...children: Child[]): HTMLElement {
  return element('details', { class: 'fold' }, element('summary', {}, element('h2', {}, title)), ...children);
}

export function button(label: string, act: () => void, attributes?: Attributes): HTMLButtonElement {
  const node = element('button', { type: 'button', ...attributes }, label);
  node.addEventListener('click', act);
  return node;
}

export function choice(label: string, options: [string, string][], chosen: string, act: (value: string) => void): HTMLLabelElement {
  const select = element('select', {}, ...options.map(([value, text]) => element('option', { value, selected: value === chosen ? '' : null }, text)));
  select.addEventListener('change', () => act(select.value));
  return element('label', { class: 'choice' }, element('span', {}, label), select);
}

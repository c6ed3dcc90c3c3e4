'use strict';
// Building the page. Text always goes in as text, so nothing in the data can become markup.
function element(tag, attributes, ...children) {
  const node = document.createElement(tag);
  return fill(node, attributes, children);
}

function shape(tag, attributes, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  return fill(node, attributes, children);
}

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value !== undefined && value !== null) node.setAttribute(name, value);
  }
  for (const child of children) {
    if (child !== undefined && child !== null) node.append(child);
  }
  return node;
}

function section(title, note, ...children) {
  return element('section', {}, element('h2', {}, title), note ? element('p', { class: 'note' }, note) : null, ...children);
}

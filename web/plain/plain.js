'use strict';
// The page of a build without npm: the answer, what was found, the pictures and every figure; no replay and no curves.
(function () {
  const report = JSON.parse(document.getElementById('record').textContent);
  const page = document.getElementById('page');
  // Text goes in as text, so nothing in the data can become markup.
  const element = (tag, name, ...children) => {
    const node = document.createElement(tag);
    if (name) node.className = name;
    node.append(...children);
    return node;
  };
  const { summary } = report;
  const words = { go: 'GO', 'go-with-warnings': 'GO with warnings', 'no-go': 'NO-GO' };
  page.append(element('h1', '', report.title), element('div', 'verdict ' + summary.grade, element('strong', '', words[summary.grade]),
    element('div', '', element('p', 'reason', report.reason))),
    element('p', 'warn-note', 'This is the plain page: understudy was built without npm, so replay and curves are left out. '
      + 'The same run stands in trace.csv beside it. Install nodejs and npm, build again, and rehearse again to have them.'));
  const rows = summary.finding_groups.map((group) => element('tr', '', element('td', 'mark', element('span', 'severity ' + group.severity, group.severity)),
    element('td', '', group.kind.replace(/_/g, ' ')), element('td', 'number', group.first_line === undefined ? '\u2013' : String(group.first_line)),
    element('td', 'number', String(group.count)), element('td', 'message', group.worst.message, element('p', 'advice', group.advice || ''))));
  page.append(element('section', '', element('h2', '', 'What was found'), rows.length ? element('table', 'findings', element('tbody', '', ...rows)) : 'Nothing.'));
  const pictures = report.pictures.map((picture) => {
    const image = element('img', '');
    image.src = picture.image;
    image.alt = picture.caption || 'scene';
    return element('figure', '', image, element('figcaption', '', picture.caption || ''));
  });
  page.append(element('section', 'pictures', ...pictures));
  const groups = Object.entries(summary).filter(([key, value]) => key !== 'provenance' && value && typeof value === 'object' && !Array.isArray(value));
  page.append(element('section', 'figures', ...groups.map(([key, values]) => element('table', '', element('caption', '', key),
    element('tbody', '', ...Object.entries(values).map(([name, value]) => element('tr', '', element('th', '', name), element('td', 'text', String(value)))))))));
  page.dataset.ready = 'plain';
})();

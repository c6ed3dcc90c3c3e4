// What was found: causes first, alike findings as one, each a way to its place in the replay, with what to do about it.
import { element } from './elements';
import { format } from './format';
import type { Clock } from './clock';
import type { Finding, FindingGroup, Report } from './record';

const kShown = 6;  // kinds of finding before the fold

export type Go = (finding: Finding) => void;

/** Leads to the instant of a finding; nothing where the run has none. */
export function leadsTo(finding: Finding, clock: Clock | null): boolean {
  return clock !== null && finding.time_s >= clock.start && finding.time_s <= clock.end + 1e-3 && (finding.time_s > 0 || finding.gcode_line !== undefined);
}

export function drawCauses(report: Report, clock: Clock | null, go: Go): HTMLElement {
  const groups = report.summary.finding_groups || [];
  const head = element('h2', {}, 'What was found, and what to do');
  if (groups.length === 0) return element('section', { class: 'causes' }, head, element('p', {}, 'Nothing: no limit was broken.'));
  const cards = groups.map((group) => causeCard(group, clock, go));
  const rest = cards.slice(kShown);
  return element('section', { class: 'causes' }, head,
    element('p', { class: 'note' }, 'Causes stand before what comes of them; alike findings are one, with their worst.'),
    element('ol', {}, ...cards.slice(0, kShown)),
    rest.length ? element('details', { class: 'fold' }, element('summary', {}, 'And ' + format.plural(rest.length, 'more kind').replace('kinds', 'kinds of finding')),
      element('ol', {}, ...rest)) : null,
    groups.length < report.summary.findings.length ? everyFinding(report, clock, go) : null);
}

function causeCard(group: FindingGroup, clock: Clock | null, go: Go): HTMLElement {
  const { worst } = group;
  const where = [
    group.first_line === undefined ? '' : group.first_line === group.last_line ? 'line ' + group.first_line : 'lines ' + group.first_line + ' to ' + group.last_line,
    group.count > 1 ? format.count(group.count) + ' times' : '',
    worst.time_s > 0 ? format.quantity(worst.time_s, 's') : '',
  ].filter(Boolean).join(' · ');
  const text = [element('span', { class: 'severity ' + group.severity }, group.severity), element('span', { class: 'kind' }, format.kind(group.kind)),
    element('span', { class: 'where' }, where), element('span', { class: 'message' }, format.message(worst.message)), meter(worst)];
  const card = leadsTo(worst, clock) ? element('button', { type: 'button', class: 'cause', title: 'Show it in the replay' }, ...text) : element('div', { class: 'cause' }, ...text);
  if (leadsTo(worst, clock)) card.addEventListener('click', () => go(worst));
  return element('li', { 'data-kind': group.kind }, card, group.advice ? element('p', { class: 'advice' }, 'What to do: ', ...withCode(group.advice)) : null);
}

function meter(finding: Finding): HTMLElement {
  return element('span', { class: 'meter' }, format.quantity(finding.value, finding.unit), element('small', {}, ' limit ' + format.quantity(finding.limit, finding.unit)));
}

// What stands between backquotes is to be typed.
function withCode(text: string): (string | HTMLElement)[] {
  return text.split('`').map((part, i) => (i % 2 ? element('code', {}, part) : part));
}

const kRows = 500;  // a page of rows; the rest stands in summary.json

function everyFinding(report: Report, clock: Clock | null, go: Go): HTMLElement {
  const { findings } = report.summary;
  const details = element('details', { class: 'fold' }, element('summary', {}, 'Each of the ' + format.count(findings.length) + ' findings'));
  details.addEventListener('toggle', () => {
    if (details.open && details.childElementCount === 1) details.append(findingsTable(findings.slice(0, kRows), clock, go),
      findings.length > kRows ? element('p', { class: 'note' }, 'The first ' + kRows + '; all of them are in summary.json.') : '');
  });
  return details;
}

function findingsTable(findings: Finding[], clock: Clock | null, go: Go): HTMLElement {
  const head = ['', 'Line', 'Time', 'Kind', 'Value', 'Limit', 'Message'];
  const numeric = new Set(['Line', 'Time', 'Value', 'Limit']);
  return element('table', { class: 'findings' },
    element('thead', {}, element('tr', {}, ...head.map((h) => element('th', { class: numeric.has(h) ? 'number' : null }, h || element('span', { class: 'unseen' }, 'Severity'))))),
    element('tbody', {}, ...findings.map((finding) => findingRow(finding, clock, go))));
}

function findingRow(finding: Finding, clock: Clock | null, go: Go): HTMLElement {
  const cell = (label: string, text: string | Node, kind?: string) => element('td', { 'data-label': label, class: kind }, text);
  const time = format.quantity(finding.time_s, 's');
  let at: string | Node = time;
  if (leadsTo(finding, clock)) {
    const link = element('button', { type: 'button', class: 'link', title: 'Show it in the replay' }, time);
    link.addEventListener('click', () => go(finding));
    at = link;
  }
  return element('tr', {},
    element('td', { class: 'mark' }, element('span', { class: 'severity ' + finding.severity }, finding.severity)),
    cell('Line', finding.gcode_line === undefined ? '\u2013' : String(finding.gcode_line), 'number'), cell('Time', at, 'number'),
    cell('Kind', format.kind(finding.kind)), cell('Value', format.quantity(finding.value, finding.unit), 'number'),
    cell('Limit', format.quantity(finding.limit, finding.unit), 'number'), cell('Message', format.message(finding.message), 'message'));
}

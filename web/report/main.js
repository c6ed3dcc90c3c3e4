'use strict';
// Reads the record and puts the page together, the answer first.
(function () {
  const report = JSON.parse(document.getElementById('record').textContent);
  const page = document.getElementById('page');
  const add = (part) => { if (part) page.append(part); };
  add(drawVerdict(report));
  add(drawFindings(report));
  add(drawPictures(report));
  add(drawCalibrationNotRun(report));
  drawCharts(report, add);
  add(drawStrands(report));
  add(drawDeviation(report));
  add(drawFrames(report));
  add(drawFigures(report));
  add(drawProvenance(report));
  window.addEventListener('beforeprint', () => {
    for (const details of document.querySelectorAll('details')) details.open = true;
  });
})();

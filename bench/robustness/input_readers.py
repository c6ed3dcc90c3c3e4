"""The inputs that input_study.py changes: for each reader good ones, with the command that reads them."""
import subprocess
from dataclasses import dataclass, field

import kill_study

SOURCE = kill_study.SOURCE
CORPUS = SOURCE / "tests/fuzz/corpus"
QUICK = "--engine quasistatic --no-pictures --max-time 300 --out out"


@dataclass
class Case:
    input: str  # the name of the input that is changed
    words: str  # of the command that reads it
    files: dict = field(default_factory=dict)  # the inputs: name and content
    before: list = field(default_factory=list)  # commands that make further inputs
    then: str = ""  # the command that takes what the first one made, where that ends with status 0 or 1
    results: tuple = ("out",)  # names that the commands may leave
    describes_truth: bool = False  # what the input describes may fail in the run: status 3, with its name
    reports: bool = False  # a refusal stands in the report of all runs, and is told on standard output

    def make(self, understudy, folder):
        for name, content in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(content)
            if content.startswith(b"#!"):
                (folder / name).chmod(0o755)
        for words in self.before:
            done = subprocess.run([understudy, *words.split()], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                  check=False)
            if done.returncode not in (0, 1):
                raise RuntimeError(f"{words}: {done.stderr}")


def of(path):
    return (SOURCE / path).read_bytes()


def first_lines(path, count):
    return b"\n".join(of(path).split(b"\n")[:count]) + b"\n"


LINE = first_lines("scenarios/song-bottle.gcode", 20)
MOVE = kill_study.MOVE.encode()
FROM_HOME = b"G21\nG91\nM83\nM109 S210\nG1 X2 F600\nG1 Z-2\nG1 X2 Y1 E0.1 F300\n"  # any machine can
PLUGIN = b"#!/bin/sh\nexec cat answer.json\n"
TEXT_BOX = b"""solid box
facet normal 0 0 1
outer loop
vertex -20 -20 1
vertex 20 -20 1
vertex 0 20 1
endloop
endfacet
facet normal 0 0 -1
outer loop
vertex -20 -20 0
vertex 0 20 0
vertex 20 -20 0
endloop
endfacet
""" + b"".join(b"facet normal 0 0 0\nouter loop\nvertex %s\nvertex %s\nvertex %s\nendloop\nendfacet\n" % corners for corners in (
    (b"-20 -20 0", b"20 -20 0", b"20 -20 1"), (b"-20 -20 0", b"20 -20 1", b"-20 -20 1"),
    (b"20 -20 0", b"0 20 0", b"0 20 1"), (b"20 -20 0", b"0 20 1", b"20 -20 1"),
    (b"0 20 0", b"-20 -20 0", b"-20 -20 1"), (b"0 20 0", b"-20 -20 1", b"0 20 1"))) + b"endsolid box\n"
SCENARIO = b"""name: short
description: A short move above the table.
source: none
machine: five-axis
program: move.gcode
fixture: bottle
material: pla
as_built: sampled
seed: 4
gap_control: "off"
engine: quasistatic
faults:
  - {fault: lost_steps, axis: x, at_s: 0.2, steps: 4}
expect:
  - {metric: verdict, equals: go, source: "nothing is in the way"}
  - {metric: print.duration_s, min: 0.01, max: 9, unit: s, source: "it moves"}
"""
CAMPAIGN = b"""name: short
description: Two speeds.
scenarios: [short.yaml]
seeds: 1-2
parameters:
  - {key: machine.motion.acceleration_mm_per_s2, values: [200, 300]}
metrics: [accuracy.tip_p95_um]
"""
POSES = "sample-poses --count 12 --as-built manufactured --seed 5 -o poses.csv"
HEXAPOD = f"rehearse line.gcode --fixture bottle {QUICK}"
TABLE = "rehearse line.gcode --machine five-axis --gap-control off"


def programs():
    yield Case("p.gcode", f"rehearse p.gcode --fixture bottle {QUICK}", {"p.gcode": LINE})
    yield Case("p.gcode", f"rehearse p.gcode --fixture bottle --machine five-axis {QUICK}",
               {"p.gcode": first_lines("scenarios/five-axis-tilted.gcode", 17)})
    yield Case("p.gcode", f"rehearse p.gcode --machine arm {QUICK}", {"p.gcode": of("scenarios/arm-square.gcode")})
    yield Case("p.gcode", f"rehearse p.gcode --machine five-axis --coordinates tip {QUICK}",
               {"p.gcode": b"G21\nG90\nM83\nM109 S210\nG0 X0 Y0 Z10 B0 C0\nG1 Z0.16 F600\nG1 X5 B20 C30 E0.2 F300\nG2 X10 Y5 I5 J0 E0.3\n"
                           b"G93\nG1 X12 B0 E0.1 F30\nG94\nG92 E0\nG10 L2 P1 X1\nG4 P200\nG1 X9 F300\n"})


def robots():
    for reader, end in (("krl", "src"), ("rapid", "mod")):
        yield reader, [Case(f"p.{end}", f"rehearse p.{end} --machine arm --bead 0.5x0.2 --temperature 210 {QUICK}",
                            {f"p.{end}": (CORPUS / reader / "square").read_bytes()})]


def machines():
    for path in sorted((SOURCE / "models").glob("*/machine.yaml")):
        files = {f"m/{file.name}": file.read_bytes() for file in path.parent.iterdir() if file.suffix != ".md"}
        yield Case("m/machine.yaml", f"rehearse p.gcode --machine m/machine.yaml --gap-control off {QUICK}", files | {"p.gcode": FROM_HOME})
    yield Case("m/machine.yaml", f"rehearse p.gcode --machine m/machine.yaml --fixture bottle {QUICK}",
               {"m/machine.yaml": of("models/hexapod/machine.yaml"), "p.gcode": LINE})


def planners():
    arm = f"rehearse plan.gcode --machine arm {QUICK}"
    made = ("out", "plan.gcode")
    yield "lattice", [Case("frame.json", "plan lattice frame.json --machine arm --place 0,0,0.05 -o plan.gcode",
                           {"frame.json": (CORPUS / "lattice/frame").read_bytes()}, then=arm, results=made)]
    yield "waypoints", [Case("layer.txt", "plan waypoints layer.txt --machine arm --place 10,20,0.13 -o plan.gcode",
                             {"layer.txt": b"".join(b"%d 5 0 0 0 1\n" % x for x in range(6))}, then=arm, results=made)]
    on_box = f"rehearse plan.gcode --fixture slanted_box {QUICK}"
    yield "curve", [Case("curve.csv", "plan surface slanted_box --curve curve.csv -o plan.gcode",
                         {"curve.csv": b"x_mm,y_mm,z_mm\n-4,0,20\n-2,1,19.4\n0,1,18.9\n2,0,18.4\n"}, then=on_box, results=made)]
    yield "svg", [Case("p.svg", "plan surface slanted_box --svg p.svg --svg-at 0,0,18 --svg-width 8 -o plan.gcode",
                       {"p.svg": of("scenarios/letters/usc.svg")}, then=on_box, results=made)]


def records():
    yield Case("a.record", "rehearse --replay a.record --machine five-axis --as-built nominal --out out", {"line.gcode": MOVE},
               [f"{TABLE} --as-built nominal {QUICK.replace('--out out', '--out first')} --record a.record"])


def result_folders():
    first = [f"{TABLE} {QUICK}"]
    yield "manifest", [Case("out/manifest.sha256", f"{TABLE} {QUICK} --seed 2", {"line.gcode": MOVE}, first)]
    yield "results", [Case("out/summary.json", "compare other out --out changes", {"line.gcode": MOVE},
                           [*first, f"{TABLE} {QUICK.replace('--out out', '--out other')} --seed 3"], results=("changes",)),
                      Case("out/trace.csv", "export trace out -o trace.h5", {"line.gcode": MOVE}, first, results=("trace.h5",)),
                      Case("out/summary.json", "verify out", {"line.gcode": MOVE}, first)]


def calibrations():
    axes = "axes --machine calibrated.yaml"
    yield "measurements", [Case("poses.csv", "calibrate poses.csv -o calibrated.yaml", before=[POSES], then=axes,
                                results=("calibrated.yaml",))]
    yield "plugin_answer", [Case("answer.json", "benchmark calibration --trials 1 --poses 12 --noise 20um:0.2mrad --disturbances none "
                                 "--estimators robust --plugin ./plugin.sh --out out",
                                 {"answer.json": (CORPUS / "plugin_answer/hexapod").read_bytes(), "plugin.sh": PLUGIN})]
    yield "pattern", [Case("places.csv", "register --fixture slanted_box --pattern places.csv -o pose.yaml",
                           {"places.csv": (CORPUS / "pattern/places").read_bytes()}, results=("pose.yaml",))]
    yield "part_pose", [Case("pose.yaml", f"{HEXAPOD} --part-pose pose.yaml", {"line.gcode": LINE},
                             ["register --fixture bottle -o pose.yaml"])]


READERS = {
    "gcode": list(programs()),
    "macros": [Case("printer.cfg", f"rehearse p.gcode --macros printer.cfg --machine five-axis {QUICK}",
                    {"printer.cfg": (CORPUS / "macros/start-print").read_bytes().split(b"---\n")[0],
                     "p.gcode": (CORPUS / "macros/start-print").read_bytes().split(b"---\n")[1]})],
    **dict(robots()),
    "machine": list(machines()),
    "urdf": [Case("m/arm.urdf", f"rehearse p.gcode --machine m/machine.yaml --gap-control off {QUICK}",
                  {"m/machine.yaml": of("models/offset-wrist-arm/machine.yaml"), "m/arm.urdf": of("models/offset-wrist-arm/arm.urdf"),
                   "p.gcode": FROM_HOME})],
    "material": [Case("m.yaml", f"{HEXAPOD} --material m.yaml", {"line.gcode": LINE, "m.yaml": of(f"models/materials/{name}.yaml")})
                 for name in ("pla", "abs")],
    "as_built": [Case("b.yaml", f"{HEXAPOD} --as-built b.yaml", {"line.gcode": LINE, "b.yaml": of("examples/as-built-hexapod.yaml")},
                      describes_truth=True),
                 Case("b.yaml", f"{TABLE} --as-built b.yaml {QUICK}", {"line.gcode": MOVE, "b.yaml": of("examples/as-built-five-axis.yaml")})],
    "fixture": [Case("f.yaml", f"rehearse line.gcode --fixture f.yaml {QUICK}",
                     {"line.gcode": LINE, "f.yaml": b"shape: bottle.stl\nsource: drawing\ntolerances: {position_mm: 0.3, rotation_mrad: 2, "
                      b"size_permille: 1, ripple_um: 3}\n", "bottle.stl": of("models/parts/bottle.stl")})],
    "stl": [Case("p.stl", f"{TABLE} --fixture p.stl {QUICK}", {"line.gcode": MOVE, "p.stl": TEXT_BOX}),
            Case("p.stl", f"{TABLE} --fixture p.stl {QUICK}", {"line.gcode": MOVE, "p.stl": of("models/parts/slanted_box.stl")}),
            Case("p.stl", "plan surface p.stl --tilt -20 20 -o plan.gcode", {"p.stl": of("models/parts/slanted_box.stl")},
                 then=f"rehearse plan.gcode --fixture p.stl {QUICK}", results=("out", "plan.gcode"))],
    "scenario": [Case("short.yaml", "scenario run short.yaml --out out", {"short.yaml": SCENARIO, "move.gcode": MOVE}, reports=True)],
    "campaign": [Case("c.yaml", "campaign c.yaml --workers 1 --out out",
                      {"c.yaml": CAMPAIGN, "short.yaml": SCENARIO, "move.gcode": MOVE})],
    "store": [Case("out/runs.sqlite", "campaign c.yaml --workers 1 --out out --resume",
                   {"c.yaml": CAMPAIGN, "short.yaml": SCENARIO, "move.gcode": MOVE}, ["campaign c.yaml --workers 1 --out out"])],
    **dict(calibrations()),
    **dict(planners()),
    "port_record": list(records()),
    **dict(result_folders()),
}

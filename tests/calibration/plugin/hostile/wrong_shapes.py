import json

print(json.dumps({"schema": "understudy.calibration-answer/2", "base_joints_mm": [[[1, 2, 3]] * 3] * 5,
                  "platform_joints_mm": {"0": "x"}, "length_offsets_mm": None}))

print('{"schema": "understudy.calibration-answer/2", "base_joints_mm": [[NaN, Infinity, -Infinity]], "length_offsets_mm": [1e999]}')

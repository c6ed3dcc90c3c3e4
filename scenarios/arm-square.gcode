; a square of 30 mm, one bead of 0.45 mm on the table; about 0.0284 mm of 1.75 mm filament a millimetre
G21
G90
M82
G94
M109 S210
M107
G0 X-15 Y-15 Z5
G1 X-15 Y-15 Z0.16 F300
G1 X15 Y-15 Z0.16 E0.852 F1200
G1 X15 Y15 Z0.16 E1.704
G1 X-15 Y15 Z0.16 E2.556
G1 X-15 Y-15 Z0.16 E3.408
G0 X-15 Y-15 Z10

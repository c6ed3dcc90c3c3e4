sleep 2
echo '{"schema": "understudy.calibration-answer/2", "failure": "late"}'

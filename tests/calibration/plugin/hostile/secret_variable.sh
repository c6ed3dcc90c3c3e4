env | grep -a HOSTILE >&2
printf '{"schema": "understudy.calibration-answer/2", "failure": "%s"}' "$HOSTILE_SECRET"
exit 1

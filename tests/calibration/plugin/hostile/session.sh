# A daemon in a session of its own.
setsid sh -c 'sleep 8; :' "$1" </dev/null >/dev/null 2>&1 &
sleep 0.1

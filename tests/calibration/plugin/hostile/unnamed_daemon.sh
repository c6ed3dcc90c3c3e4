# A daemon whose parent is gone, in a session of its own, without our environment.
(setsid env -i /bin/sh -c '/bin/sleep 8; :' "$1" </dev/null >/dev/null 2>&1 &)
sleep 0.1

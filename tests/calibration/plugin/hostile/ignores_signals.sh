trap '' TERM HUP INT QUIT PIPE ALRM XCPU USR1 USR2
sh -c "trap '' TERM HUP INT QUIT; sleep 8; sleep 8" "$1"
sleep 8

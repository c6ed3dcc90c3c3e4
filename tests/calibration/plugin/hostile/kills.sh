# Its parent and us.
kill -9 $PPID "$3" 2>/dev/null
kill -9 $PPID "$3" 2>/dev/null
exit 0

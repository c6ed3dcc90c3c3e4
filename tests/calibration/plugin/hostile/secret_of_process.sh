# The environment with which we were started.
grep -qa PATH= "/proc/$3/environ" 2>/dev/null && echo HOSTILE_SECRET: environment >&2
exit 1

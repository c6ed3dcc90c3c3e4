# Writes to whatever it was given open.
for n in 3 4 5 6 7 8 9; do
  eval "echo '$1' >&$n"
done 2>/dev/null
exit 0

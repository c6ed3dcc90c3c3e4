# Leaves a process behind that has its streams.
sh -c 'sleep 8; :' "$1" &
echo nonsense

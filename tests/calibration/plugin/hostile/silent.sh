exec >&- 2>&-
sh -c 'sleep 8; :' "$1"

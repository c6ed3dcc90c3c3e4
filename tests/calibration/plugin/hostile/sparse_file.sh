# 10 GB of which nothing is written.
exec truncate -s 10G "${TMPDIR:-/tmp}/$1"

# 20 MB in files of 1 MB.
i=0
while [ $i -lt 20 ]; do
  head -c 1000000 /dev/zero > "${TMPDIR:-/tmp}/$1.$i" || exit 1
  i=$((i + 1))
done

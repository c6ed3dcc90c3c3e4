exec yes "$1"

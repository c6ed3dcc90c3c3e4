"""Attaches to us as a debugger, and reads our memory."""
import ctypes
import sys

PTRACE_ATTACH = 16
them = int(sys.argv[3])
if ctypes.CDLL(None).ptrace(PTRACE_ATTACH, them, 0, 0) == 0:
    print("HOSTILE_SECRET: traced", file=sys.stderr)
try:
    open(f"/proc/{them}/mem", "rb").close()
    print("HOSTILE_SECRET: memory", file=sys.stderr)
except OSError:
    pass
sys.exit(1)

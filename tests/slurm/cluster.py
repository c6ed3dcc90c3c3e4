"""A Slurm cluster of two nodes on loopback, for as long as the object lives. Needs Debian's slurmctld, slurmd, munge and
slurm-client, and root; Unavailable says what is missing."""
import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

PROGRAMS = ("munged", "mungekey", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")


class Unavailable(Exception):
    pass


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    def __init__(self, nodes=2):
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        missing = [p for p in PROGRAMS if not shutil.which(p)]
        if missing:
            raise Unavailable(f"{', '.join(missing)} not installed (slurmctld slurmd munge slurm-client)")
        if os.geteuid() != 0:
            raise Unavailable("only root starts slurmd")
        self.folder = Path(tempfile.mkdtemp(prefix="understudy-slurm-"))
        self.folder.chmod(0o755)
        self.names = [f"n{i + 1}" for i in range(nodes)]
        self.daemons = {}
        try:
            self._munge()
            self._configure()
            self._start("slurmctld", ["slurmctld", "-D"])
            for name in self.names:
                self.start_node(name)
            self._wait_idle()
        except BaseException:
            self.close()
            raise

    def _start(self, name, words):
        log = open(self.folder / f"{name}.out", "ab")
        self.daemons[name] = subprocess.Popen(words, stdout=log, stderr=log, stdin=subprocess.DEVNULL, env=self.environment())

    def environment(self):
        return dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"))

    def _munge(self):
        folder = self.folder / "munge"
        folder.mkdir(mode=0o755)
        user = pwd.getpwnam("munge")
        subprocess.run(["mungekey", "--create", f"--keyfile={folder / 'key'}"], check=True)
        os.chmod(folder / "key", 0o400)
        for path in (folder, folder / "key"):
            os.chown(path, user.pw_uid, user.pw_gid)
        self.socket = folder / "socket"
        log = open(self.folder / "munged.out", "ab")
        self.daemons["munged"] = subprocess.Popen(
            ["munged", "--foreground", f"--key-file={folder / 'key'}", f"--socket={self.socket}",
             f"--pid-file={folder / 'pid'}", f"--log-file={folder / 'log'}", f"--seed-file={folder / 'seed'}"],
            user=user.pw_uid, group=user.pw_gid, extra_groups=[], stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        self._wait(lambda: self.socket.exists(), "munged makes no socket", 20)

    def _configure(self):
        host, state = socket.gethostname(), self.folder / "state"
        state.mkdir()
        lines = [
            "ClusterName=loopback", f"SlurmctldHost={host}(127.0.0.1)", "SlurmUser=root", "SlurmdUser=root",
            f"SlurmctldPort={free_port()}", "AuthType=auth/munge", f"AuthInfo=socket={self.socket}",
            "ProctrackType=proctrack/linuxproc", "TaskPlugin=task/none", "JobAcctGatherType=jobacct_gather/none",
            "AccountingStorageType=accounting_storage/none", "MpiDefault=none", "ReturnToService=2",
            "SelectType=select/cons_tres", "SelectTypeParameters=CR_Core", "SlurmdParameters=config_overrides",
            "SlurmctldTimeout=30", "SlurmdTimeout=10", "InactiveLimit=0", "MinJobAge=60", "KillWait=5",
            "SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,bf_interval=2", "RequeueExit=",
            f"StateSaveLocation={state}", f"SlurmdSpoolDir={state}/spool.%n", f"SlurmctldPidFile={state}/slurmctld.pid",
            f"SlurmdPidFile={state}/slurmd.%n.pid", f"SlurmctldLogFile={self.folder}/slurmctld.log",
            f"SlurmdLogFile={self.folder}/slurmd.%n.log"]
        lines.remove("RequeueExit=")
        for name in self.names:
            lines.append(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={free_port()} CPUs=1 RealMemory=2000")
        lines.append("PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP")
        (self.folder / "slurm.conf").write_text("\n".join(lines) + "\n")

    def start_node(self, name):
        self._start(name, ["slurmd", "-D", "-N", name])

    def kill_node(self, name):
        """Its slurmd, and all that it started."""
        daemon = self.daemons.pop(name)
        daemon.kill()
        daemon.wait()
        for pid in self._on_node(name):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def _on_node(self, name):
        """Processes of its jobs, each after the slurmstepd that watches it."""
        found = []
        here = {f"SLURM_CONF={self.folder / 'slurm.conf'}".encode(), f"SLURMD_NODENAME={name}".encode()}
        for process in Path("/proc").iterdir():
            try:
                if not process.name.isdigit() or not here <= set((process / "environ").read_bytes().split(b"\0")):
                    continue
                parent = (process / "stat").read_text().rpartition(")")[2].split()[1]
                if Path(f"/proc/{parent}/comm").read_text().strip() == "slurmstepd":
                    found.append(int(parent))
                found.append(int(process.name))
            except OSError:
                pass
        return found

    def _wait(self, condition, why, seconds):
        end = time.time() + seconds
        while not condition():
            if time.time() > end:
                raise RuntimeError(f"{why}: see {self.folder}")
            time.sleep(0.2)

    def run(self, words):
        return subprocess.run(words, env=self.environment(), capture_output=True, text=True, stdin=subprocess.DEVNULL)

    def _wait_idle(self):
        self._wait(lambda: self.run(["sinfo", "-h", "-N", "-o", "%T"]).stdout.split().count("idle") == len(self.names),
                   "the nodes do not become idle", 60)

    def close(self):
        for daemon in reversed(list(self.daemons.values())):
            if daemon.poll() is None:
                daemon.terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

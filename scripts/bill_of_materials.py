#!/usr/bin/env python3
"""Writes the bill of materials of a build by Ninja, as CycloneDX 1.5: the Debian packages of the libraries that the
command loads, of the headers that were compiled into it and of the files that it embeds; each with version, source
and licences; and the npm packages that are bundled into its pages.

usage: bill_of_materials.py BUILD -o FILE [--notices FILE] [--release VERSION] [--optional]

BUILD/cli/understudy is the command, BUILD/lib/understudy has the modules that it loads, BUILD/embedded.txt lists what
it embeds. --notices writes the copyright files of what is compiled in or embedded, which licences want beside a copy. Status 1, and nothing written: a file belongs to no
package, or a package states no licence. With --optional that is a warning, for builds with libraries of their own.
"""
import argparse
import json
import os
import re
import subprocess
import sys
from pathlib import Path

# In the precompiled header, but not in what is compiled with it.
OF_TESTS = {"libgmock-dev", "libgtest-dev"}

# What Debian calls a licence, and its name in the SPDX list. Others keep Debian's words.
SPDX = {"Apache-2": "Apache-2.0", "Apache-2.0": "Apache-2.0", "BSD-2-clause": "BSD-2-Clause", "BSD-3-clause": "BSD-3-Clause",
        "BSD-3-Clause": "BSD-3-Clause", "BSL-1": "BSL-1.0", "BSL-1.0": "BSL-1.0", "CC0-1.0": "CC0-1.0", "Expat": "MIT",
        "MIT": "MIT", "GPL-1+": "GPL-1.0-or-later",
        "GPL-2": "GPL-2.0-only", "GPL-2+": "GPL-2.0-or-later", "GPL-3": "GPL-3.0-only", "GPL-3+": "GPL-3.0-or-later",
        "ISC": "ISC", "LGPL-2": "LGPL-2.0-only", "LGPL-2+": "LGPL-2.0-or-later", "LGPL-2.1": "LGPL-2.1-only",
        "LGPL-2.1+": "LGPL-2.1-or-later", "LGPL-3": "LGPL-3.0-only", "LGPL-3+": "LGPL-3.0-or-later",
        "MPL-2": "MPL-2.0", "MPL-2.0": "MPL-2.0", "Qhull": "Qhull", "X11": "X11", "Zlib": "Zlib", "zlib": "Zlib"}

# Texts by which a licence is known where a copyright file is not machine readable.
TEXTS = {"MIT": "Permission is hereby granted, free of charge, to any person obtaining",
         "BSD": "Redistribution and use in source and binary forms",
         "HPND": "Permission to use, copy, modify, (and )?distribute",
         "GCC Runtime Library Exception": "GCC (RUNTIME LIBRARY EXCEPTION|Runtime Library Exception)"}


class Fault(Exception):
    pass


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})


def loaded_files(program):
    """Real names of the shared libraries that the program loads."""
    found = run("ldd", program)
    if found.returncode != 0:
        raise Fault(f"ldd {program}: {found.stderr.strip()}")
    missing = re.findall(r"(\S+) => not found", found.stdout)
    if missing:
        raise Fault(f"{program} needs {', '.join(missing)}, which is not installed")
    return sorted({os.path.realpath(f) for f in re.findall(r"(/\S+) \(0x", found.stdout)})


def owners(files):
    """Package by file. Debian's database knows some files by their names before /lib moved into /usr."""
    names = {f.removeprefix("/usr"): f for f in files if f.startswith("/usr/lib")} | {f: f for f in files}
    packages = {}
    for line in run("dpkg-query", "-S", *names).stdout.splitlines():
        package, _, name = line.partition(": ")
        packages[names[name]] = package.split(", ")[0]
    return packages


def compiled_in(build):
    """Headers of others that Ninja recorded for objects of the command, and embedded files of others."""
    found = run("ninja", "-C", build, "-t", "deps")
    headers, product = set(), False
    for line in found.stdout.splitlines():
        if not line.startswith(" "):
            product = ": #deps" in line and not line.startswith(("tests/", "bench/"))
        elif product and line.strip().startswith("/usr/"):
            headers.add(os.path.realpath(line.strip()))
    if not headers:
        raise Fault(f"{build} records no headers: it is no finished build by Ninja")
    embedded = (Path(build) / "embedded.txt").read_text().splitlines()
    return sorted(headers | {os.path.realpath(f) for f in embedded if f.startswith("/usr/")})


def licences_of(text):
    """Licences of a copyright file, and where they were found in it."""
    if re.search(r"^Format:.*copyright-format", text, re.M):
        names = []
        for paragraph in re.split(r"\n\s*\n", text):
            files = re.search(r"^Files:\s*((?:.*\n?)(?:[ \t]+.*\n?)*)", paragraph, re.M)
            licence = re.search(r"^License:[ \t]*(.+)$", paragraph, re.M)
            only_packaging = files and all(f.startswith("debian/") for f in files[1].split())
            if licence and not only_packaging:
                names.append(licence[1].strip())
        return sorted(set(names)), "machine-readable copyright file"
    names = {"in common-licenses: " + name.rstrip(".") for name in re.findall(r"common-licenses/([\w.+-]+)", text)}
    words = " ".join(text.split())
    names |= {name for name, pattern in TEXTS.items() if re.search(pattern, words)}
    return sorted(names), "words of the copyright file"


def copyright_text(package):
    file = Path("/usr/share/doc") / package.split(":")[0] / "copyright"
    try:
        return file.read_text(errors="replace")
    except OSError:
        raise Fault(f"package {package} has no {file}") from None


def licence_value(name):
    return {"license": {"id": SPDX[name]} if name in SPDX else {"name": name}}


def components(roles):
    """One a package, in the order of their names."""
    fields = "${Package}\t${Version}\t${Architecture}\t${source:Package}\t${source:Version}\n"
    found = run("dpkg-query", "-W", "-f", fields, *roles)
    parts = {}
    for line in found.stdout.splitlines():
        name, version, architecture, source, source_version = line.split("\t")
        licences, how = licences_of(copyright_text(name))
        if not licences:
            raise Fault(f"package {name}: /usr/share/doc/{name}/copyright states no licence that is known here")
        purl = f"pkg:deb/debian/{name}@{version}?arch={architecture}".replace("+", "%2B")
        parts[name] = {
            "type": "library", "bom-ref": purl, "name": name, "version": version, "purl": purl,
            "licenses": [licence_value(licence) for licence in licences],
            "properties": [{"name": "understudy:source", "value": f"{source} {source_version}"},
                           {"name": "understudy:part", "value": ", ".join(sorted(roles[name]))},
                           {"name": "understudy:licences-from", "value": how}]}
    return [parts[name] for name in sorted(parts)]


def package_roles(build):
    """package -> set of words that say how it came in."""
    roles = {}
    programs = [Path(build) / "cli/understudy", *sorted(Path(build).glob("lib/understudy/*.so"))]
    loaded = sorted({file for program in programs for file in loaded_files(str(program))})
    for role, files in (("loaded", loaded), ("compiled in", compiled_in(build))):
        package_of = owners(files)
        strangers = [f for f in files if f not in package_of]
        if strangers:
            raise Fault(f"{strangers[0]} belongs to no package")
        for package in {name.split(":")[0] for name in package_of.values()} - OF_TESTS:
            roles.setdefault(package, set()).add(role)
    return roles


def bundled(build):
    """The npm packages within the page's script, as web/build.mjs wrote them; none in the plain page."""
    listed = Path(build) / "web/packages.json"
    if str(listed) not in (Path(build) / "embedded.txt").read_text():
        return []
    return [{"type": "library", "bom-ref": f"pkg:npm/{p['name']}@{p['version']}", "name": p["name"], "version": p["version"],
             "purl": f"pkg:npm/{p['name']}@{p['version']}".replace("/@", "/%40"), "licenses": [licence_value(p["license"])],
             "properties": [{"name": "understudy:part", "value": "embedded"},
                            {"name": "understudy:licences-from", "value": "package.json"}]}
            for p in json.loads(listed.read_text())]


def bill(roles, pages, release):
    parts = components(roles) + pages
    ours = {"type": "application", "bom-ref": "understudy", "name": "understudy", "version": release,
            "licenses": [licence_value("Apache-2.0")]}
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "metadata": {"component": ours},
            "components": parts,
            "dependencies": [{"ref": "understudy", "dependsOn": [part["bom-ref"] for part in parts]}]}


def notices(roles):
    """The copyright files, each once, of all but compiler, C library and kernel, which except programs from theirs."""
    packages_of = {}
    for package in sorted(package for package, role in roles.items() if "compiled in" in role):
        if re.match("libc6-|libgcc-|libstdc|linux-", package):
            continue
        packages_of.setdefault(copyright_text(package).rstrip(), []).append(package)
    line = "=" * 100
    return "".join(f"{line}\n{', '.join(packages)}\n{line}\n{text}\n\n" for text, packages in packages_of.items())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("-o", dest="out", required=True)
    parser.add_argument("--notices")
    parser.add_argument("--release", default="0")
    parser.add_argument("--optional", action="store_true")
    options = parser.parse_args()
    try:
        roles = package_roles(options.build)
        pages = bundled(options.build)
        text = json.dumps(bill(roles, pages, options.release), indent=1) + "\n"
        compiled = notices(roles) if options.notices else ""
        if pages:
            compiled += f"{'=' * 100}\nwithin report.html\n{'=' * 100}\n" + (Path(options.build) / "web/notices.txt").read_text()
    except Fault as fault:
        print(f"bill_of_materials.py: {fault}", file=sys.stderr)
        for file in filter(None, (options.out, options.notices)):
            Path(file).unlink(missing_ok=True)
        return 0 if options.optional else 1
    Path(options.out).write_text(text)
    if options.notices:
        Path(options.notices).write_text(compiled)
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Follows every citation in the tree: links and anchors of the pages, docs/PAGE.md#anchor and file names in comments,
and papers with their sections, equations, figures and tables against the bibliography of docs/reference.md.

    scripts/check_citations.py [ROOT]

One line for each citation that leads nowhere, then status 1; status 0 if there is none. Python 3 alone.
"""
import pathlib
import re
import sys

BIBLIOGRAPHY = "docs/reference.md"
SKIPPED_FOLDERS = {".git", "build", "out", "node_modules", "third_party"}
TEXT = {".md", ".h", ".cpp", ".py", ".yaml", ".yml", ".cmake", ".txt", ".js", ".css", ".html", ".sh", ".glsl", ".in", ""}
MONTHS = {"January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November", "December"}
NOT_AUTHORS = MONTHS | {"Measured", "Copyright", "In", "Since", "ISO"}
KINDS = {"section": "sections", "sections": "sections", "appendix": "sections", "appendices": "sections", "eq": "equations",
         "eqs": "equations", "equation": "equations", "equations": "equations", "figure": "figures", "figures": "figures",
         "table": "tables", "tables": "tables", "definition": "definitions", "definitions": "definitions"}

ITEM = r"(?:[A-Z]\d*|\d+)(?:\.\d+)*"
NAME = r"[A-Z][a-z\u00c0-\u024f]+"
AUTHOR_YEAR = re.compile(rf"\b({NAME}(?:(?:,| and)(?: Van)? {NAME})*) ((?:19|20)\d\d)\b")
NEXT_PART = re.compile(r"(?:,| and|)\s+(?:(%s) )?(%s)(?:-(%s))?(?![\w%%])(?! (?:mm|um|deg))" % ("|".join(KINDS), ITEM, ITEM))
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)|<(?:img|a)\s[^>]*?(?:src|href)=\"([^\"]+)\"")
PAGE = re.compile(r"(?<![\w/.-])docs/([\w/-]+\.md)(#[\w-]+)?")
HEARSAY = re.compile(r"\b[Rr]eference(?:'s)? (?:section |sections )?[A-M]\b(?!-)|\[R\] the project's reference")


def text_files(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if any(p in SKIPPED_FOLDERS for p in parts[:-1]) or not path.is_file() or path.suffix not in TEXT:
            continue
        if path.stat().st_size > 1 << 20 or path.resolve() == pathlib.Path(__file__).resolve():
            continue
        try:
            yield path, path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue


def without_code(text):
    """A page with its fenced blocks blanked, lines kept."""
    inside, lines = False, []
    for line in text.split("\n"):
        if line.lstrip().startswith("```"):
            inside = not inside
            line = ""
        lines.append("" if inside else line)
    return "\n".join(lines)


def anchors(text):
    """The anchors that GitHub gives to the headings of a page."""
    found = set(re.findall(r"<a (?:name|id)=\"([^\"]+)\"", text))
    for heading in re.findall(r"^#{1,6} +(.+?) *#*$", without_code(text), re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        base = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        name, n = base, 0
        while name in found:
            n += 1
            name = f"{base}-{n}"
        found.add(name)
    return found


def flow(path, text):
    """The text as one line, comment marks at line starts removed, so that a citation may run over two lines. With the number of the line at each place."""
    mark = re.compile(r"\s*(?:\|\s*)?" if path.suffix == ".md" else r"\s*(?://[/!<]*|#(?!include)|\*+(?!/))?\s*")
    out, line_at = [], []
    for number, line in enumerate(text.split("\n"), 1):
        line = line[mark.match(line).end():].rstrip() + " "
        out.append(line)
        line_at.extend([number] * len(line))
    return "".join(out), line_at


def expand(first, last):
    """The parts from `first` to `last`: 3, 4, 5 or A1, A2."""
    if last is None:
        return [first]
    letter = first.rstrip("0123456789")
    if not first[len(letter):].isdigit() or not last[len(letter):].isdigit():
        return [first, last]
    return [f"{letter}{n}" for n in range(int(first[len(letter):]), int(last[len(letter):]) + 1)]


def read_bibliography(root):
    """Name of each work, and what may be cited of it: {name: {kind: parts}}; {} where anything may."""
    text = (root / BIBLIOGRAPHY).read_text(encoding="utf-8")
    works = {}
    for name, entry in re.findall(r"^- \*\*([^*]+)\*\*(.*?)(?=^- |\Z)", text, re.M | re.S):
        has = re.search(r"\bHas: (.*)", entry, re.S)
        works[name] = {}
        for group in (has.group(1).split(";") if has else []):
            kind, _, parts = group.strip().rstrip(".").partition(" ")
            works[name][KINDS[kind]] = {p for part in re.split(r",\s*", parts) for p in expand(*(part.split("-") + [None])[:2])}
    return works


def check_papers(path, text, works, report):
    flowing, line_at = flow(path, text)
    for match in AUTHOR_YEAR.finditer(flowing):
        name, line = f"{match[1]} {match[2]}", line_at[match.start()]
        if path.name == "reference.md" and flowing.find("## Bibliography ") in range(match.start()):
            break
        if match[1] in NOT_AUTHORS or match[1].split()[-1] in NOT_AUTHORS:
            continue
        if name not in works:
            report(path, line, f"'{name}' is not in the bibliography of {BIBLIOGRAPHY}")
            continue
        has, at, kind = works[name], match.end(), "sections"
        part = NEXT_PART.match(flowing, at)
        while has and part:
            kind = KINDS[part[1]] if part[1] else kind
            for wanted in (p for p in (part[2], part[3]) if p):
                if wanted not in has.get(kind, ()):
                    report(path, line, f"'{name}' has no {kind[:-1]} {wanted}")
            at = part.end()
            part = NEXT_PART.match(flowing, at)


def check_links(root, path, text, pages, report):
    for number, line in enumerate(without_code(text).split("\n"), 1):
        for match in LINK.finditer(re.sub(r"`[^`]*`", "", line)):
            target = match[1] or match[2]
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            to = (path.parent / name).resolve() if name else path
            if not to.exists():
                report(path, number, f"the link leads to {target}, which is not there")
            elif anchor and anchor not in pages.get(to, ()):
                report(path, number, f"the link leads to {target}, but that page has no heading '#{anchor}'")


def check_pages(root, path, text, pages, report):
    for number, line in enumerate(text.split("\n"), 1):
        for match in PAGE.finditer(line):
            to = (root / "docs" / match[1]).resolve()
            if to not in pages:
                report(path, number, f"docs/{match[1]} is not there")
            elif match[2] and match[2][1:] not in pages[to]:
                report(path, number, f"docs/{match[1]} has no heading '{match[2]}'")
    flowing, line_at = flow(path, text)
    for match in HEARSAY.finditer(flowing):
        report(path, line_at[match.start()], f"'{match[0]}' is nowhere to be found: cite {BIBLIOGRAPHY}#section")


def check_file_names(root, path, text, names, report):
    """Names of files in pages: `room/file`, with or without ending, with * for any."""
    for number, line in enumerate(text.split("\n"), 1):
        for match in names.finditer(line):
            name = match[1].rstrip("/.,")
            if "NAME" in name:  # stands for any
                continue
            if not any(any(folder.glob(name)) or any(folder.glob(name + ".*")) for folder in (root, path.parent)):
                report(path, number, f"{name} is not there")


def check_folders(root, path, text, report):
    """Folders that a README names (`plant/`) stand in its own folder or in the root; those of a table row, in the row's first folder."""
    for number, line in enumerate(without_code(text).split("\n"), 1):
        row = re.match(r"\| `([a-z_]+)/`", line)
        if path.name != "README.md" and not row:
            continue
        room = root / row[1] if row else path.parent
        for name in re.findall(r"(?<![\w/.-])([a-z_]+)/(?![\w/])", line):
            if not (root / name).is_dir() and not any(room.rglob(name)):
                report(path, number, f"there is no folder {name}/")


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
    files = list(text_files(root))
    pages = {path.resolve(): anchors(text) for path, text in files if path.suffix == ".md"}
    works = read_bibliography(root)
    rooms = "|".join(sorted(p.name for p in root.iterdir() if p.is_dir() and p.name not in SKIPPED_FOLDERS and p.name[0] != "."))
    names = re.compile(r"(?<![\w/.<-])(?:\.\./)?((?:%s)/[\w.*/-]*\w[\w*/]*)(?![<\w])" % rooms)
    broken = []

    def report(path, line, message):
        broken.append(f"{path.relative_to(root)}:{line}: {message}")

    for path, text in files:
        check_papers(path, text, works, report)
        check_pages(root, path, text, pages, report)
        if path.suffix == ".md":
            check_links(root, path, text, pages, report)
            check_folders(root, path, text, report)
            check_file_names(root, path, text, names, report)
    print("\n".join(broken) if broken else f"{len(files)} files: every citation resolves", file=sys.stderr if broken else sys.stdout)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())

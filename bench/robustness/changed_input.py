"""Changes of a good input, as damage and mistakes make them."""
import re

NUMBERS = [b"0", b"-0", b"1", b"-1", b"0.5", b"90", b"-180", b"1e-9", b"1e9", b"1e300", b"-1e300", b"1e999", b"nan", b".nan", b"-.inf",
           b"1e5", b"2147483648", b"18446744073709551616", b"0x10", b"1.", b"~", b"1e-300", b"100", b"1000000"]
NUMBER = re.compile(rb"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]*")


def other_value(random, data):
    """A number a tenth, ten times, a little more or less, of the other sign, another of the text, or one that is seldom thought of."""
    found = list(NUMBER.finditer(data))
    if not found:
        return other_bytes(random, data)
    at = random.choice(found)
    value, kind = float(at[0]), random.randrange(6)
    new = (b"%.9g" % (value * random.choice((0.1, 10))), b"%.9g" % (value * random.uniform(0.7, 1.4)), b"%.9g" % -value,
           random.choice(found)[0], random.choice(NUMBERS), random.choice(NUMBERS))[kind]
    return data[:at.start()] + new + data[at.end():]


def other_word(random, data):
    found = list(WORD.finditer(data))
    if not found:
        return other_bytes(random, data)
    at, other = random.choice(found), random.choice(found)[0]
    new = random.choice((other, b"", at[0] + b"s", at[0][:-1]))
    return data[:at.start()] + new + data[at.end():]


def other_lines(random, data):
    """A line less, one twice, two exchanged."""
    lines = data.split(b"\n")
    i, j, kind = random.randrange(len(lines)), random.randrange(len(lines)), random.randrange(3)
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(j, lines[i])
    else:
        lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def other_bytes(random, data):
    new = bytearray(data or b" ")
    for _ in range(random.choice((1, 1, 4))):
        new[random.randrange(len(new))] = random.randrange(256)
    return bytes(new)


def cut_off(random, data):
    return data[:random.randrange(len(data) + 1)]


TEXT = {"number": other_value, "word": other_word, "lines": other_lines, "bytes": other_bytes, "cut off": cut_off}
BINARY = {"bytes": other_bytes, "cut off": cut_off}


def is_text(data):
    try:
        return "\0" not in data.decode()
    except UnicodeDecodeError:
        return False


def changed(random, data):
    """The kind of the change, and the changed input. In a text it is mostly a number or a word, which leaves the form of the file."""
    if not is_text(data):
        kind = random.choice(list(BINARY))
        return kind, BINARY[kind](random, data)
    kind = random.choice(["number"] * 4 + ["word"] * 2 + list(TEXT))
    return kind, TEXT[kind](random, data)

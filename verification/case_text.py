"""Texts of generated scenarios and cases, as generate.py puts them together."""

G = 9.81
NOTE = "# Written by verification/generate.py.\n"
FILES = {}


def scenario(name, *, title, gravity=(0.0, -G), rock, joints, step, blocks, histories=(), stages, solver="", extra="", accept=""):
    """blocks: (name, ring, further lines); histories: (name, block, point); stages: text; accept: a warning of what is meant."""
    accepted = f'accept_warnings = ["{accept}"]\n' if accept else ""
    text = NOTE + f'title = "{title}"\n{accepted}gravity = {point(gravity)}\n\n[rock]\n{rock}\n\n[joints]\n{joints}\n\n[time]\nstep = {step}\n'
    for block, ring, more in blocks:
        text += f'\n[[block]]\nname = "{block}"\nouter = [{", ".join(point(p) for p in ring)}]\n{more}'
    for history, block, p in histories:
        text += f'\n[[history]]\nname = "{history}"\nblock = "{block}"\npoint = {point(p)}\n'
    text += "\n" + extra + stages
    if solver:
        text += f"\n[solver]\n{solver}\n"
    FILES[f"scenarios/{name}.toml"] = text


def case(name, text):
    FILES[f"{name}.toml"] = NOTE + text


def number(x):
    x = round(x, 15)
    return repr(float(x if x != 0 else 0.0))


def point(p):
    return f"[{number(p[0])}, {number(p[1])}]"


def box(x, y, width, height):
    return [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]


def quantity(name, value, unit="", **what):
    lines = [f'\n[[run.quantity]]\nname = "{name}"']
    if unit:
        lines.append(f'unit = "{unit}"')
    lines.append(f'value = "{value}"')
    for key, text in what.items():
        quoted = isinstance(text, str) and not text.startswith("[")
        lines.append(f'{key} = "{text}"' if quoted else f"{key} = {text}")
    return "\n".join(lines) + "\n"


def largest(columns):
    """An expression: the largest size over columns."""
    parts = [f"maxabs('{c}')" for c in columns]
    while len(parts) > 1:
        parts = [f"max({', '.join(parts[k:k + 2])})" if k + 1 < len(parts) else parts[k] for k in range(0, len(parts), 2)]
    return parts[0]


STIFF_ROCK = 'density = 2600.0\nyoung = 5.0e10\npoisson = 0.2\nstate = "plane-stress"'
FIXED = "fixed = true\n"

"""Scenarios that are right, from a seed: tunnels in joint sets, grids of blocks, loose blocks; every rule of integration.
Half of them are demanding: soft joints, orders above 1 and "auto", tunnels under in-situ stress, slopes that are cut, stones
that roll. Small, so that a run takes a second."""

import math
import random


def number(value):
    return f"{value:.6g}"


def points(ring):
    return "[" + ", ".join(f"[{x:.4f}, {y:.4f}]" for x, y in ring) + "]"


class Writer:
    """One scenario. `kind` says which sort it is; `facts` what a table of results groups it by."""

    def __init__(self, seed):
        self.draw = random.Random(seed)
        self.demanding = self.chance(0.5)
        self.kind = self.draw.choice(["tunnel", "cut", "rolling"] if self.demanding else ["tunnel", "grid", "loose"])
        self.tables = [f'title = "random {seed} {self.kind}"\nseed = {seed}']
        self.size = 1.0  # of blocks, m
        self.slope = 0.0  # of the base
        self.facts = {"kind": self.kind, "demanding": self.demanding}

    def uniform(self, low, high):
        return self.draw.uniform(low, high)

    def scale(self, low, high):
        """As often between 1 and 10 as between 10 and 100."""
        return math.exp(self.uniform(math.log(low), math.log(high)))

    def chance(self, share):
        return self.draw.random() < share

    def add(self, title, **keys):
        lines = [title]
        for key, value in keys.items():
            if value is None:
                continue
            text = value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else number(value)
            lines.append(f"{key} = {text}")
        self.tables.append("\n".join(lines))

    def materials(self):
        young = self.scale(1e9, 5e10)
        order = self.draw.choice([1, 2, 2, 3, '"auto"'] if self.demanding else [1, 1, 2])
        self.facts["order"] = order
        self.add(
            "[rock]", density=self.uniform(2000, 3000), young=young, poisson=self.uniform(0.0, 0.35),
            state=self.draw.choice(['"plane-strain"', '"plane-stress"']), order=order,
        )  # fmt: skip
        stiffness = self.scale(1.5e8, 2e10) if self.demanding else young * self.scale(0.5, 40.0) if self.chance(0.5) else None
        cohesion = self.scale(1e3, 1e6) if self.chance(0.3) else None
        self.add(
            "[joints]", friction=self.uniform(5, 60), cohesion=cohesion,
            tension=0.1 * cohesion if cohesion and self.chance(0.5) else None, normal_stiffness=stiffness,
        )  # fmt: skip

    def solver(self):
        rule = self.draw.choice(["shi", "average-acceleration", "generalized-alpha"])
        self.draw.randrange(3)  # of a key that is gone: the scenarios of a seed stay what they were
        self.facts |= {"integrator": rule}
        self.add(
            "[solver]", integrator=f'"{rule}"',
            spectral_radius=self.uniform(0, 1) if rule == "generalized-alpha" and self.chance(0.7) else None,
            theta=self.uniform(0, 1) if rule == "shi" and self.chance(0.3) else None,
            restitution=self.uniform(0, 1) if self.chance(0.5) else None,
            face_contacts=self.draw.randint(2, 4) if self.chance(0.3) else None,
        )  # fmt: skip
        self.add("[time]", step=self.draw.choice([0.002, 0.005, 0.01] if self.demanding else [0.001, 0.002, 0.005]))

    def joint_set(self, name, dip, extent):
        mean = self.uniform(0.18, 0.35) * extent
        self.size = min(self.size, mean)
        shape = self.draw.choice(["constant", "uniform", "normal", "lognormal", "exponential"])
        std = self.uniform(0.1, 0.4) * mean
        spacing = f'{{ mean = {number(mean)}, std = {number(std)}, distribution = "{shape}" }}'
        gap = f'{{ mean = {number(0.3 * mean)}, distribution = "exponential" }}' if self.chance(0.3) else "0"
        self.add(
            "[[joint_set]]", name=f'"{name}"', dip=dip, dip_direction=self.draw.choice([90, 270]), spacing=spacing,
            dip_std=self.uniform(0, 5) if self.chance(0.3) else None,
            length=f'{{ mean = {number(self.uniform(0.5, 2.0) * extent)}, distribution = "constant" }}', gap=gap,
            friction=self.uniform(10, 50) if self.chance(0.3) else None,
        )  # fmt: skip

    def tunnel(self):
        half = self.uniform(3, 6)
        self.add("[section]", azimuth=90.0)
        self.add("[domain]", x=f"[{-half:.3f}, {half:.3f}]", y=f"[{-half:.3f}, {half:.3f}]", boundary='"frame"')
        self.joint_set("A", self.uniform(0, 40), 2 * half)
        self.joint_set("B", self.uniform(50, 90), 2 * half)
        if self.chance(0.3):
            self.joint_set("C", self.uniform(20, 70), 2 * half)
        if self.chance(0.5):
            self.add("[[excavation]]", name='"E"', shape='"circle"', center="[0, 0]", diameter=self.uniform(0.5, 0.9) * half, chords=24)
        else:
            width = self.uniform(0.5, 0.9) * half
            self.add("[[excavation]]", name='"E"', shape='"horseshoe"', invert=f"[0, {-0.5 * width:.3f}]", width=width, wall_height=0.4 * width, chords=24)
        if self.demanding:
            self.add("[in_situ]", depth=self.uniform(5, 300), k0=self.uniform(0.3, 1.5))
        elif self.chance(0.5):
            self.add("[in_situ]", depth=self.uniform(5, 100), k0=self.uniform(0.3, 1.5))
        return "E"

    def grid(self):
        """A wall of rectangles on a base."""
        width, height = self.uniform(0.4, 1.5), self.uniform(0.3, 1.0)
        columns, rows = self.draw.randint(1, 4), self.draw.randint(1, 4)
        self.size = min(width, height)
        self.base(2.0 * columns * width + 2.0)
        bond = 0.5 * width if self.chance(0.5) else 0.0
        for row in range(rows):
            shift = bond if row % 2 else 0.0
            for column in range(columns):
                x, y = column * width + shift, row * height
                ring = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
                self.add("[[block]]", name=f'"g{row}_{column}"', outer=points(ring))

    def loose(self):
        """Polygons that fall on a base, apart from each other at the start."""
        count = self.draw.randint(1, 5)
        slope = self.base(4.0 * count + 4.0)
        for k in range(count):
            radius = self.uniform(0.3, 0.9)
            self.size = min(self.size, radius)
            corners = self.draw.randint(3, 8)
            start = self.uniform(0, 2 * math.pi)
            turn = 2 * math.pi / corners
            angles = [start + turn * (c + self.uniform(-0.3, 0.3)) for c in range(corners)]
            x = 3.5 * k + self.uniform(-0.7, 0.7)
            y = slope * x + self.uniform(1.3, 2.5)
            ring = [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]
            self.add(
                "[[block]]", name=f'"b{k}"', outer=points(ring),
                velocity=f"[{self.uniform(-3, 3):.3f}, {self.uniform(-3, 1):.3f}]" if self.chance(0.5) else None,
                spin=self.uniform(-2, 2) if self.chance(0.3) else None,
                order=self.draw.randint(1, 4) if self.chance(0.2) else None,
            )  # fmt: skip

    def cut(self):
        """A slope that an excavation lays bare: a block on a joint that comes out of the new wall, and what stands on it."""
        height, dip = self.uniform(2, 12), math.radians(self.uniform(15, 50))
        wall = math.radians(self.uniform(math.degrees(dip) + 5, 90))
        low = self.uniform(0.05, 0.4) * height
        face = lambda y: y / math.tan(wall)  # noqa: E731
        back = lambda y: face(low) + (y - low) / math.tan(dip)  # noqa: E731
        far, front = back(height) + height, -2 * height
        split = self.uniform(0.3, 0.7) * (height - low) + low
        self.size = height - low
        blocks = {
            "below": [(front, -height), (far, -height), (far, height), (back(height), height), (face(low), low), (0, 0), (front, 0)],
            "front": [(front, 0), (0, 0), (face(low), low), (face(height), height), (front, height)],
        }
        if self.chance(0.5):
            blocks["lower"] = [(face(low), low), (back(split), split), (face(split), split)]
            blocks["upper"] = [(face(split), split), (back(split), split), (back(height), height), (face(height), height)]
            self.size = min(self.size, math.sqrt(0.5 * (split - low) * abs(back(split) - face(split))))
        else:
            blocks["slider"] = [(face(low), low), (back(height), height), (face(height), height)]
        for name, ring in blocks.items():
            self.add("[[block]]", name=f'"{name}"', outer=points(ring), fixed=True if name == "below" and self.chance(0.5) else None)
        self.add("[[block]]", name='"floor"', outer=points([(front, -height - 1), (far, -height - 1), (far, -height), (front, -height)]), fixed=True)
        self.add("[[excavation]]", name='"E"', shape='"polygon"', outer=points(blocks["front"]))
        return "E"

    def rolling(self):
        """Stones of many corners that roll down a slope."""
        self.slope = math.tan(math.radians(self.uniform(5, 35)))
        self.base(40.0)
        for k in range(self.draw.randint(1, 4)):
            radius, corners = self.uniform(0.2, 0.8), self.draw.randint(4, 12)
            self.size = min(self.size, radius)
            angles = [2 * math.pi / corners * (c + self.uniform(-0.2, 0.2)) for c in range(corners)]
            x = 3.0 * k
            y = self.slope * x + 1.1 * radius / math.cos(math.atan(self.slope)) + self.uniform(0, 5)
            ring = [(x + radius * math.cos(a), y + radius * math.sin(a)) for a in angles]
            speed = self.uniform(0, 6)
            self.add(
                "[[block]]", name=f'"s{k}"', outer=points(ring), velocity=f"[{-speed:.3f}, {-speed * self.slope:.3f}]",
                spin=self.uniform(0, speed / radius),
            )  # fmt: skip

    def base(self, width):
        """A fixed block below [0, 0]; returns its slope."""
        slope = self.slope
        if self.kind == "loose" and self.chance(0.4):
            slope = math.tan(math.radians(self.uniform(0, 25)))
        ring = [(-width, -slope * width), (-width, -slope * width - 1.0), (width, -slope * width - 1.0), (width, slope * width)]
        if slope == 0.0:
            ring = [(-width, 0.0), (-width, -1.0), (width, -1.0), (width, 0.0)]
        self.add("[[block]]", name='"base"', outer=points(ring), fixed=True)
        return slope

    def stages(self, excavation):
        shakes = self.kind != "rolling" and self.chance(0.6)
        if shakes:
            frequency = self.uniform(1, 8)
            sine = f"{{ amplitude = {number(self.uniform(0.5, 8))}, frequency = {number(frequency)}, cycles = {self.draw.randint(1, 3)} }}"
            self.add("[[motion]]", name='"m"', **{self.draw.choice(["x", "y"]): sine})
        names = f'["{excavation}"]' if excavation else None
        if self.demanding and excavation:
            self.add("[[stage]]", name='"in place"', kind='"settle"', max_steps=150)
        if self.kind not in ("loose", "rolling") or self.chance(0.2):
            self.add("[[stage]]", name='"settle"', kind='"settle"', max_steps=150, excavate=names)
            names = None
        if shakes:
            self.add("[[stage]]", name='"shake"', kind='"shake"', motion='"m"', duration=self.uniform(0.1, 0.4), excavate=names)
        else:
            # Stones have to come down before they roll.
            duration = self.uniform(1.0, 3.0) if self.kind == "rolling" else self.uniform(0.1, 0.6)
            self.add("[[stage]]", name='"rest"', kind='"rest"', duration=duration, excavate=names)

    def write(self):
        self.materials()
        excavation = getattr(self, self.kind)()
        self.solver()
        self.stages(excavation)
        return "\n".join(self.tables) + "\n"


def random_scenario(seed):
    """The text of a scenario, what it is made of, and the size of its blocks in m: the same for the same seed."""
    writer = Writer(seed)
    text = writer.write()
    return text, writer.facts, writer.size

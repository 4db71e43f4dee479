"""Scenarios that are right, from a seed, with the keys of waves, staged opening and support together: [boundary] × release × pressure with
arc × springs with yield and install × damping × until = "still" × tilt × water × strength that a stage reduces, with every rule of integration, both contacts, orders 1 to 3."""

from random_scenario import Writer, number


class WriterOfAllKeys(Writer):
    """Tunnels in joint sets, and blocks on a base, with as many keys as go together."""

    def __init__(self, seed):
        super().__init__(seed)
        self.kind = self.draw.choice(["tunnel", "tunnel", "grid", "loose"])
        self.tables[0] = f'title = "random {seed}, all keys, {self.kind}"\nseed = {seed}'
        self.facts |= {"kind": self.kind}
        if self.chance(0.25):
            self.tables[0] += f"\ntilt = {number(self.uniform(-12, 12))}"
        self.springs = []
        self.has_boundary = False

    def tunnel(self):
        half = self.uniform(3, 6)
        self.add("[section]", azimuth=90.0)
        boundary = self.chance(0.7)
        self.add(
            "[domain]", x=f"[{-half:.3f}, {half:.3f}]", y=f"[{-half:.3f}, {half:.3f}]",
            boundary=None if boundary else '"frame"',
        )  # fmt: skip
        self.joint_set("A", self.uniform(0, 40), 2 * half)
        self.joint_set("B", self.uniform(50, 90), 2 * half)
        stressed = boundary or self.chance(0.5)
        if stressed:
            self.add("[in_situ]", depth=self.uniform(1, 80) + half, k0=self.uniform(0.4, 1.5))
        if boundary:
            self.add(
                "[boundary]", base=self.draw.choice(['"compliant"', '"rigid"']),
                sides=self.draw.choice(['"free-field"', '"free-field"', '"roller"', '"viscous"']),
                top='"overburden"' if self.chance(0.7) else None,
            )  # fmt: skip
        self.has_boundary = boundary
        pressure = arc = None
        if self.chance(0.5):
            pressure = self.draw.choice(
                [number(self.scale(1e3, 1e5)), f"{{ open = {number(self.scale(1e3, 1e5))}, after = 0.0 }}"]
            )
            if self.chance(0.5):
                arc = f"[{number(self.uniform(-40, 30))}, {number(self.uniform(150, 220))}]"
        width = self.uniform(0.5, 0.8) * half
        self.add("[[excavation]]", name='"E"', shape='"circle"', center="[0, 0]", diameter=width, chords=20, pressure=pressure, arc=arc)
        # Where both ends lie in one block, the scenario is refused.
        for k in range(self.draw.randint(0, 2)):
            side = 1 if k == 0 else -1
            self.add(
                "[[spring]]", name=f'"K{k}"', **{"from": f"[{side * 0.62 * width:.3f}, {self.uniform(-0.3, 0.3):.3f}]"},
                to=f"[{side * 0.92 * half:.3f}, {self.uniform(0.5, 0.8) * half:.3f}]", stiffness=self.scale(1e6, 1e8),
                **{"yield": self.scale(1e3, 1e5) if self.chance(0.5) else None},
            )  # fmt: skip
            self.springs.append(f'"K{k}"')
        return "E"

    def solver(self):
        super().solver()
        if not self.chance(0.3):
            return
        kinds = ["stiffness", "rayleigh", "mass"] if self.has_boundary else ["stiffness"]
        self.tables.append(
            f'[solver.damping]\nkind = "{self.draw.choice(kinds)}"\nratio = {number(self.uniform(0.01, 0.1))}\n'
            f"frequency = {number(self.uniform(1, 8))}"
        )

    def stages(self, excavation):
        still = self.chance(0.4)
        frequency, share = self.uniform(1, 8), self.uniform(0.2, 0.9)
        sine = f"{{ amplitude = {number(self.uniform(0.3, 6))}, frequency = {number(frequency)}, cycles = {self.draw.randint(1, 3)} }}"
        self.add("[[motion]]", name='"m"', **{self.draw.choice(["x", "x", "y"]): sine})
        install = f"[{', '.join(self.springs)}]" if self.springs and self.chance(0.7) else None
        opened = '["E"]' if excavation else None
        released = excavation is not None and self.chance(0.5)
        self.add(
            "[[stage]]", name='"open"', kind='"settle"', max_steps=200, excavate=opened, release=share if released else None,
        )  # fmt: skip
        if released or install:
            self.add("[[stage]]", name='"held"', kind='"settle"', max_steps=200, release=1.0 if released else None, install=install)
        self.add("[[stage]]", name='"shake"', kind='"shake"', motion='"m"', scale=self.uniform(0.3, 2.5), duration=self.uniform(0.1, 0.5))
        self.add(
            "[[stage]]", name='"after"', kind='"rest"', duration=self.uniform(0.1, 0.6),
            until='"still"' if still else None, still_time=0.05 if still else None,
        )  # fmt: skip


def scenario_of_all_keys(seed):
    """As random_scenario()."""
    writer = WriterOfAllKeys(seed)
    text = writer.write()
    if seed % 3 == 0:  # no draw, so that scenarios of other seeds stay
        text += f"\n[water]\ntable = [[-2.0, {(seed % 7) - 2}.5], [2.0, {seed % 5}.25]]\n"
    if seed % 5 == 2:
        text = text.replace('name = "after"\n', f'name = "after"\nstrength_factor = {1.0 + (seed % 7) / 3.0:.3f}\n')
    return text, writer.facts, writer.size

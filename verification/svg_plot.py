"""Line charts as SVG; standard library alone."""
import math

COLORS = ["#1f4e79", "#c0392b", "#1e8449", "#8e44ad", "#b9770e", "#2e86c1", "#7b241c", "#566573"]
WIDTH, HEIGHT = 680, 400
LEFT, RIGHT, TOP, BOTTOM = 74, 190, 34, 52


def escape(text):
    return str(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def nice_ticks(low, high, wanted=6):
    raw = (high - low) / wanted
    power = 10 ** math.floor(math.log10(raw))
    step = next(m * power for m in (1, 2, 2.5, 5, 10) if m * power >= raw * 0.999)
    first = math.ceil(low / step - 1e-9)
    return [round(k * step, 12) for k in range(first, math.floor(high / step + 1e-9) + 1)]


def log_ticks(low, high):
    return [10.0**k for k in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)]


class Chart:
    """Curves over x. `line`: points joined; `marks`: points alone; both may be called for one name."""

    def __init__(self, title, x_label, y_label, log_y=False):
        self.title, self.x_label, self.y_label, self.log_y = title, x_label, y_label, log_y
        self.curves, self.x_range, self.y_range = [], None, None

    def line(self, name, x, y, dash="", color=None, marker=None):
        self.curves.append({"name": name, "x": list(x), "y": list(y), "line": True, "dash": dash, "color": color,
                            "marker": marker})

    def marks(self, name, x, y, color=None, marker="circle"):
        self.curves.append({"name": name, "x": list(x), "y": list(y), "line": False, "dash": "", "color": color,
                            "marker": marker})

    def _ranges(self):
        xs = [v for c in self.curves for v in c["x"]]
        ys = [v for c in self.curves for v in c["y"]]
        x = self.x_range or (min(xs), max(xs))
        if self.y_range:
            return x, self.y_range
        if self.log_y:
            return x, (10 ** math.floor(math.log10(min(ys))), 10 ** math.ceil(math.log10(max(ys))))
        margin = 0.05 * (max(ys) - min(ys))
        return x, (min(ys) - margin, max(ys) + margin)

    def svg(self):
        (x0, x1), (y0, y1) = self._ranges()
        inner_w, inner_h = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
        scale = math.log10 if self.log_y else (lambda v: v)

        def px(x):
            return LEFT + inner_w * (x - x0) / (x1 - x0)

        def py(y):
            return TOP + inner_h * (1 - (scale(y) - scale(y0)) / (scale(y1) - scale(y0)))

        out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
               f'height="{HEIGHT}" font-family="sans-serif" font-size="12" role="img">',
               f"<title>{escape(self.title)}</title>",
               f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
               f'<text x="{LEFT}" y="20" font-size="14" font-weight="bold">{escape(self.title)}</text>',
               f'<clipPath id="area"><rect x="{LEFT}" y="{TOP}" width="{inner_w}" height="{inner_h}"/></clipPath>']
        for v in nice_ticks(x0, x1):
            out.append(f'<path d="M{px(v):.1f} {TOP}V{TOP + inner_h}" stroke="#e5e7e9"/>'
                       f'<text x="{px(v):.1f}" y="{TOP + inner_h + 17}" text-anchor="middle">{v:g}</text>')
        for v in log_ticks(y0, y1) if self.log_y else nice_ticks(y0, y1):
            out.append(f'<path d="M{LEFT} {py(v):.1f}H{LEFT + inner_w}" stroke="#e5e7e9"/>'
                       f'<text x="{LEFT - 7}" y="{py(v) + 4:.1f}" text-anchor="end">{v:g}</text>')
        out.append(f'<rect x="{LEFT}" y="{TOP}" width="{inner_w}" height="{inner_h}" fill="none" stroke="#566573"/>')
        out.append(f'<text x="{LEFT + inner_w / 2}" y="{HEIGHT - 14}" text-anchor="middle">{escape(self.x_label)}</text>')
        out.append(f'<text transform="translate(18 {TOP + inner_h / 2}) rotate(-90)" text-anchor="middle">'
                   f'{escape(self.y_label)}</text>')
        for k, curve in enumerate(self.curves):
            color = curve["color"] or COLORS[k % len(COLORS)]
            points = [(px(x), py(y)) for x, y in zip(curve["x"], curve["y"])]
            legend_y = TOP + 8 + 19 * k
            legend_x = WIDTH - RIGHT + 12
            if curve["line"]:
                dash = f' stroke-dasharray="{curve["dash"]}"' if curve["dash"] else ""
                style = f'fill="none" stroke="{color}" stroke-width="1.8"{dash}'
                path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
                out.append(f'<path d="{path}" {style} clip-path="url(#area)"/>')
                out.append(f'<path d="M{legend_x} {legend_y}h24" {style}/>')
            if curve["marker"]:
                out += [self._mark(x, y, curve["marker"], color) for x, y in points]
                out.append(self._mark(legend_x + 12, legend_y, curve["marker"], color))
            out.append(f'<text x="{legend_x + 30}" y="{legend_y + 4}">{escape(curve["name"])}</text>')
        return "\n".join(out) + "\n</svg>\n"

    @staticmethod
    def _mark(x, y, kind, color):
        if kind == "cross":
            return f'<path d="M{x - 4:.1f} {y - 4:.1f}l8 8m0 -8l-8 8" stroke="{color}" stroke-width="1.8"/>'
        if kind == "square":
            return f'<rect x="{x - 3.5:.1f}" y="{y - 3.5:.1f}" width="7" height="7" fill="none" stroke="{color}" stroke-width="1.5"/>'
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.2" fill="{color}"/>'

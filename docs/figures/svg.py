# SPDX-License-Identifier: Apache-2.0
"""A drawing in SVG: shapes in data coordinates, mapped to a panel of the page. Numbers have one decimal, so that
the files are the same on every machine."""

PAPER, INK, MUTED, LINE = "#fbfaf7", "#26323d", "#6b7680", "#c3c9cf"
BLUE, FILL, ORANGE, RED, GREEN = "#2468a8", "#d5e4f1", "#dd7a00", "#c22f2f", "#2e8555"


def number(x):
    return f"{x:.1f}".replace("-0.0", "0.0")


class Page:
    def __init__(self, width, height, title):
        self.width, self.height = width, height
        self.parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                      f'font-family="Helvetica, Arial, sans-serif" font-size="14">', f"<title>{title}</title>",
                      f'<rect width="{width}" height="{height}" rx="8" fill="{PAPER}"/>']
        self.clips = 0

    def text(self, x, y, words, color=INK, anchor="start", size=14, weight="normal"):
        for i, line in enumerate(words.replace("&", "&amp;").replace("<", "&lt;").split("\n")):
            self.parts.append(f'<text x="{number(x)}" y="{number(y + 20 * i)}" fill="{color}" text-anchor="{anchor}" '
                              f'font-size="{size}" font-weight="{weight}">{line}</text>')

    def legend(self, x, y, entries, step=0):
        """entries: (kind, color, words); in one row, or in a column with `step` 0."""
        for kind, color, words in entries:
            if kind == "dot":
                self.parts.append(f'<circle cx="{number(x + 8)}" cy="{number(y - 5)}" r="4.5" fill="{color}"/>')
            elif kind in ("line", "dash"):
                dash = ' stroke-dasharray="4 3"' if kind == "dash" else ""
                self.parts.append(f'<line x1="{number(x)}" y1="{number(y - 5)}" x2="{number(x + 18)}" '
                                  f'y2="{number(y - 5)}" stroke="{color}" stroke-width="2.5"{dash}/>')
            else:
                self.parts.append(f'<rect x="{number(x)}" y="{number(y - 12)}" width="18" height="13" fill="{color}" '
                                  f'stroke="{LINE}"/>')
            self.text(x + 25, y, words)
            if step:
                x += step
            else:
                y += 21

    def panel(self, x, y, width, height, centre, span):
        return Panel(self, x, y, width, height, centre, span)

    def write(self, path):
        path.write_text("\n".join([*self.parts, "</svg>"]) + "\n", encoding="utf-8")


class Panel:
    """Shapes in data coordinates, y up; `span` of them fit into the width. What leaves the panel is clipped."""

    def __init__(self, page, x, y, width, height, centre, span):
        self.page, self.x, self.y, self.width, self.height = page, x, y, width, height
        self.centre, self.scale = centre, width / span
        page.clips += 1
        self.clip = f"c{page.clips}"
        page.parts.append(f'<clipPath id="{self.clip}"><rect x="{number(x)}" y="{number(y)}" width="{number(width)}" '
                          f'height="{number(height)}" rx="4"/></clipPath>')
        page.parts.append(f'<rect x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}" '
                          f'rx="4" fill="#ffffff" stroke="{LINE}"/>')

    def at(self, p):
        return (self.x + self.width / 2 + (p[0] - self.centre[0]) * self.scale,
                self.y + self.height / 2 - (p[1] - self.centre[1]) * self.scale)

    def holds(self, p):
        x, y = self.at(p)
        return self.x - 9 < x < self.x + self.width + 9 and self.y - 9 < y < self.y + self.height + 9

    def add(self, shape):
        self.page.parts.append(f'<g clip-path="url(#{self.clip})">{shape}</g>')

    def dots(self, points, color=MUTED, radius=2.6):
        shapes = (f'<circle cx="{number(x)}" cy="{number(y)}" r="{radius}"/>' for x, y in map(self.at, filter(self.holds, points)))
        self.add(f'<g fill="{color}" stroke="none" stroke-width="1.6">{"".join(shapes)}</g>')

    def path(self, points, color=INK, width=1.5, fill="none", closed=False, dash=False, opacity=1):
        d = "M" + "L".join(f"{number(x)} {number(y)}" for x, y in map(self.at, points)) + ("Z" if closed else "")
        more = ' stroke-dasharray="4 3"' if dash else ""
        more += f' fill-opacity="{opacity}"' if opacity != 1 else ""
        self.add(f'<path d="{d}" fill="{fill}" stroke="{color}" stroke-width="{width}" stroke-linejoin="round"{more}/>')

    def lines(self, pairs, color=LINE, width=1.0):
        d = "".join("M" + "L".join(f"{number(x)} {number(y)}" for x, y in map(self.at, pair)) for pair in pairs)
        self.add(f'<path d="{d}" fill="none" stroke="{color}" stroke-width="{width}"/>')

    def triangles(self, corners, color, width, fill):
        """Those with a corner in the panel, as one shape: overlaps count as inside if all have the same direction."""
        d = "".join("M" + "L".join(f"{number(x)} {number(y)}" for x, y in map(self.at, triangle)) + "Z"
                    for triangle in corners if any(map(self.holds, triangle)))
        self.add(f'<path d="{d}" fill="{fill}" stroke="{color}" stroke-width="{width}" stroke-linejoin="round"/>')

    def circle(self, centre, radius, color=INK, width=1.5, fill="none", dash=False, opacity=1):
        x, y = self.at(centre)
        more = ' stroke-dasharray="5 4"' if dash else ""
        self.add(f'<circle cx="{number(x)}" cy="{number(y)}" r="{number(radius * self.scale)}" fill="{fill}" '
                 f'fill-opacity="{opacity}" stroke="{color}" stroke-width="{width}"{more}/>')

    def label(self, p, words, dx=6, dy=-6, color=INK, size=14, weight="normal"):
        x, y = self.at(p)
        self.page.text(x + dx, y + dy, words, color, size=size, weight=weight)

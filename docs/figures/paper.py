# SPDX-License-Identifier: Apache-2.0
"""Part B of docs/method.md, plainly and in memory, for the figures. Coherence (B.1) is left out."""

import math

def eligible_edges(points, around, evaluations, max_prob=1.1, max_total=3.0):
    """(w_total, low, high), in the order in which they are taken."""
    edges = []
    for p in range(len(points)):
        for q in around[p]:
            if q < p:
                continue
            a, b = evaluations[p], evaluations[q]
            prob = 2 - a.probability - b.probability
            density = round(2 * math.dist(points[p], points[q]) / (a.r + b.r) * 2**24) / 2**24
            if prob < max_prob and prob + density < max_total:
                edges.append((prob + density, p, q))
    return sorted(edges)


def path_length(graph, start, goal, most):
    """Edges on the shortest path, or None if there are more than `most`."""
    level, seen = [start], {start}
    for steps in range(most + 1):
        if goal in level:
            return steps
        level = [r for q in level for r in sorted(graph[q]) if r not in seen and not seen.add(r)]
    return None


def spanning_graph(count, edges, e):
    graph = [set() for _ in range(count)]
    root = list(range(count))

    def find(p):
        while root[p] != p:
            p = root[p]
        return p
    for _, p, q in edges:
        if find(p) != find(q):
            root[find(p)] = find(q)
        elif path_length(graph, p, q, e - 1) is not None:
            continue
        graph[p].add(q)
        graph[q].add(p)
    return graph


def loop_through(graph, origin):
    """The loop that the breadth-first search from the origin closes, or None."""
    parent, branch, queue = {origin: None}, {origin: None}, [origin]
    for p in queue:
        for q in sorted(graph[p]):
            if q == parent[p]:
                continue
            if q not in parent:
                parent[q], branch[q] = p, q if p == origin else branch[p]
                queue.append(q)
            elif p != origin and q != origin and branch[p] != branch[q]:
                ways = []
                for end in (p, q):
                    way = [end]
                    while parent[way[-1]] is not None:
                        way.append(parent[way[-1]])
                    ways.append(way)
                return ways[0][::-1] + ways[1][:-1]
    return None


def paper_loops(graph):
    on_loop, loops = set(), []
    for origin in range(len(graph)):
        loop = loop_through(graph, origin) if origin not in on_loop else None
        if loop:
            loops.append(loop)
            on_loop.update(loop)
    return loops

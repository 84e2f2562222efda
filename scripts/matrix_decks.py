"""What the scripts that make bodies of other programs' matrices share: decks of Abaqus and CalculiX, and files."""

import os


class Wrong(Exception):
    """Input that cannot be converted."""


def cards(path, depth=0):
    """Of a deck with its includes: file, line, words of the card in capitals and its options, rows of cells."""
    if depth > 20:
        raise Wrong("%s: *INCLUDE goes round in a circle" % path)
    try:
        with open(path, errors="replace") as file:
            lines = file.read().splitlines()
    except OSError as error:
        raise Wrong("%s: %s; expected the deck" % (path, error.strerror)) from error
    found, goes_on = [], False
    for number, line in enumerate(lines, 1):
        line = line.strip()
        if not line or line.startswith("**"):
            continue
        cells = [cell.strip() for cell in line.split(",")]
        if not line.startswith("*"):
            if found:
                found[-1][4].append((number, cells))
            continue
        if goes_on:
            cells = found[-1][5] + cells
        goes_on = cells[-1] == ""
        options = {}
        for cell in cells[1:]:
            key, _, value = cell.partition("=")
            options[key.strip().upper()] = value.strip().strip('"')
        card = (path, number, "".join(cells[0].upper().split()), options, [], cells[:-1])
        if card[2] == "*INCLUDE":
            name = options.get("INPUT", "")
            place = os.path.join(os.path.dirname(path), name)
            found += cards(place, depth + 1)
        else:
            found.append(card)
    return found


def number_of(path, line, cell, kind):
    try:
        return kind(cell)
    except ValueError:
        raise Wrong("%s, line %d: %r is no number" % (path, line, cell)) from None


def places_and_sets(deck):
    """Coordinates of every node, and the nodes of every set by its name in capitals."""
    places, sets = {}, {}
    for path, _, card, options, rows, _ in cards(deck):
        if card == "*NODE":
            for line, cells in rows:
                node = number_of(path, line, cells[0], int)
                x = [number_of(path, line, cell, float) for cell in cells[1:4] if cell]
                places[node] = x + [0.0] * (3 - len(x))
                if "NSET" in options:
                    sets.setdefault(options["NSET"].upper(), []).append(node)
        elif card == "*NSET":
            own = sets.setdefault(options.get("NSET", "").upper(), [])
            for line, cells in rows:
                cells = [cell for cell in cells if cell]
                if "GENERATE" in options:
                    numbers = [number_of(path, line, cell, int) for cell in cells] + [1]
                    if len(numbers) not in (3, 4) or numbers[2] < 1:
                        raise Wrong("%s, line %d: expected first, last and step of nodes" % (path, line))
                    own.extend(range(numbers[0], numbers[1] + 1, numbers[2]))
                    continue
                for cell in cells:
                    if cell.isdigit():
                        own.append(int(cell))
                    elif cell.upper() in sets:
                        own.extend(sets[cell.upper()])
                    else:
                        raise Wrong("%s, line %d: %s is no node, and no *NSET before" % (path, line, cell))
        elif card == "*TRANSFORM":
            raise Wrong("%s: *TRANSFORM turns the directions of rows; expected x, y and z at every node" % path)
        elif card in ("*INSTANCE", "*PART"):
            raise Wrong(
                "%s: %s numbers nodes anew; expected a deck without parts and assemblies, as Abaqus/CAE writes it with"
                " the model attribute \"Do not use parts and assemblies in input files\"" % (path, card)
            )
    return places, sets


def nodes_of_set(deck, sets, name):
    """The nodes of a set, each once."""
    if name.upper() not in sets:
        raise Wrong("%s: no *NSET %s; it has %s" % (deck, name, ", ".join(sorted(sets)) or "none"))
    return sorted(set(sets[name.upper()]))


def lists_of_nodes(deck, sets, seats, fixed=None):
    """File and nodes of each seat, seat.csv of the only one, and of what is fixed."""
    names = ["seat.csv"] if len(seats) == 1 else ["%s.csv" % seat.lower() for seat in seats]
    if len(set(names)) < len(names) or set(names) & {"nodes.csv", "fixed.csv"}:
        raise Wrong("--seat %s: expected sets with names of their own, other than nodes and fixed" % " ".join(seats))
    lists = [(name, nodes_of_set(deck, sets, seat)) for name, seat in zip(names, seats)]
    if fixed is not None:
        lists.append(("fixed.csv", nodes_of_set(deck, sets, fixed)))
    return lists


def write_nodes(out, places, nodes, lists):
    """Writes nodes.csv in the order of the rows, and a file for each list of nodes."""
    with open(os.path.join(out, "nodes.csv"), "w") as file:
        file.write("node,x,y,z\n")
        file.writelines("%d,%r,%r,%r\n" % (node, *places[node]) for node in nodes)
    for name, own in lists:
        with open(os.path.join(out, name), "w") as file:
            file.write("node\n")
            file.writelines("%d\n" % node for node in own)


def write_matrix(path, n, entries):
    """A Matrix Market file of the lower triangle: (row, column, digits), rows and columns from 1."""
    with open(path, "w") as file:
        file.write("%%MatrixMarket matrix coordinate real symmetric\n")
        file.write("%d %d %d\n" % (n, n, len(entries)))
        file.writelines("%d %d %s\n" % entry for entry in entries)

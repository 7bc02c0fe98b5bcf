"""The transfer function that a plant of the service means, and whether it is the one of a problem."""

SAME = 1e-12  # relative to the largest coefficient


def polynomial(roots, gain):
    """Coefficients in descending powers."""
    a = [complex(gain)]
    for root in roots:
        a = [x - root * y for x, y in zip([*a, 0], [0, *a])]
    return [x.real for x in a]


def transfer_function(plant):
    """num, den and L of a plant as the service answers it."""
    L = plant.get("L", 0)
    if plant["type"] == "zpk":
        roots = {key: [complex(*z) if isinstance(z, list) else complex(z) for z in plant[key]]
                 for key in ("zeros", "poles")}
        return polynomial(roots["zeros"], plant["K"]), polynomial(roots["poles"], 1), L
    if plant["type"] == "transfer_function":
        return plant["num"], plant["den"], L
    if plant["type"] == "fopdt":
        return [plant["K"]], [plant["T"], 1], L
    if plant["type"] == "sopdt" and "T1" in plant:
        return [plant["K"]], [plant["T1"] * plant["T2"], plant["T1"] + plant["T2"], 1], L
    if plant["type"] == "sopdt":
        return [plant["K"]], [plant["T"] ** 2, 2 * plant["zeta"] * plant["T"], 1], L
    if plant["type"] == "ipdt":
        return [plant["K"]], [plant.get("T", 0), 1, 0], L
    raise ValueError(f"The kind of plant {plant['type']} is not supported here.")


def same_plant(problem, plant):
    """True if num, den and L of the problem are those of its text."""
    def scaled(num, den):
        while den[0] == 0:
            den = den[1:]
        while num[0] == 0:
            num = num[1:]
        return [x / den[0] for x in num], [x / den[0] for x in den]
    num, den, L = transfer_function(plant)
    wanted, found = scaled(problem["num"], problem["den"]), scaled(num, den)
    return L == problem["L"] and all(
        len(a) == len(b) and all(abs(x - y) <= SAME * max(map(abs, a)) for x, y in zip(a, b))
        for a, b in zip(wanted, found))

"""Writes the tables beside it with mpmath (https://mpmath.org), 36 significant digits from 80-digit arithmetic.

Arguments are IEEE doubles, printed so that they read back exactly; a function is evaluated at exactly those doubles.
"""
import random
from mpmath import mp, mpf, mpc
import mpmath as M

mp.dps = 80
random.seed(1)


def write(name, header, rows):
    with open(name + ".csv", "w") as f:
        f.write(header + "\n")
        for row in rows:
            f.write(",".join(x if isinstance(x, str) else repr(x) if isinstance(x, float) else M.nstr(x, 36, strip_zeros=False) for x in row) + "\n")


def log_uniform(low, high):
    return 10.0 ** random.uniform(low, high)


def elementary():
    sec = lambda x: 1 / M.cosh(x)
    signed = lambda low, high: random.choice([-1, 1]) * log_uniform(low, high)
    draws = {
        "expm1": (M.expm1, lambda: signed(-12, 1.5)), "log1p": (M.log1p, lambda: random.choice([-0.9, 30.0]) * log_uniform(-12, 0)),
        "x_minus_sin": (lambda x: x - M.sin(x), lambda: signed(-6, 1.2)), "sinh": (M.sinh, lambda: signed(-12, 1.5)),
        "cosh": (M.cosh, lambda: signed(-3, 1.5)), "sech": (sec, lambda: signed(-3, 1.5)), "tanh": (M.tanh, lambda: signed(-12, 1.5)),
        "asinh": (M.asinh, lambda: signed(-12, 5)), "atan": (M.atan, lambda: signed(-12, 12)), "asin": (M.asin, lambda: signed(-12, 0)),
    }
    edges = [0.5, -0.5, 0.5000000001, -0.4999999999, 1.0]
    rows = []
    for name, (f, draw) in draws.items():
        for x in [draw() for _ in range(24)] + edges:
            if name == "log1p" and x <= -1: continue
            rows.append((name, x, f(mpf(x))))
    write("elementary", "function,x,value", rows)


def carlson():
    rows = []
    for i in range(40):
        x, y, z, p = [log_uniform(-8, 8) if i % 2 else random.uniform(0.01, 2) for _ in range(4)]
        if i % 5 == 0: x = 0.0
        rows.append(("rf", x, y, z, p, M.elliprf(x, y, z)))
        rows.append(("rc", x, y, z, p, M.elliprc(x, y)))
        rows.append(("rd", x, y, z, p, M.elliprd(x, y, z)))
        rows.append(("rj", x, y, z, p, M.elliprj(x, y, z, p)))
    # Arguments so close together that the series alone answers, at the edge of its range in double-double.
    near = random.Random(2)
    for i in range(16):
        x, y, z, p = [1 + near.choice([-1.3e-4, 0.3e-4, 1.3e-4]) for _ in range(4)]
        rows.append(("rf", x, y, z, p, M.elliprf(x, y, z)))
        rows.append(("rj", x, y, z, p, M.elliprj(x, y, z, p)))
    write("carlson", "function,x,y,z,p,value", rows)


MC = [1.0, 0.9, 0.5, 0.1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-16, 1e-20, 1e-30]


def elliptic():
    rows = []
    for mc in MC:
        m = 1 - mpf(mc)
        rows.append(("complete_f", 0.0, 1.0, mc, M.ellipk(m)))
        rows.append(("complete_e", 0.0, 1.0, mc, M.ellipe(m)))
        for i in range(8):
            phi = [random.uniform(-1.57, 1.57), 1.5707963267948966 - log_uniform(-15, -1), random.uniform(-60, 60)][i % 3]
            nc = [random.uniform(0.05, 0.95), log_uniform(-6, 0), random.uniform(1, 4)][random.randrange(3)]
            n = 1 - mpf(nc)
            turns = M.nint(mpf(phi) / M.pi)
            rest = mpf(phi) - turns * M.pi
            f = lambda x: M.ellipf(x, m)
            s, c = M.sin(rest), M.cos(rest)
            d2 = c * c + mpf(mc) * s * s
            pi_rest = s * M.elliprf(c * c, d2, 1) + n / 3 * s**3 * M.elliprj(c * c, d2, 1, 1 - n * s * s)
            pi_complete = M.ellippi(n, m)
            rows.append(("f", phi, nc, mc, 2 * turns * M.ellipk(m) + M.ellipf(rest, m)))
            rows.append(("e", phi, nc, mc, 2 * turns * M.ellipe(m) + M.ellipe(rest, m)))
            rows.append(("pi", phi, nc, mc, 2 * turns * pi_complete + pi_rest))
        for nc in [0.5, 2.5]:
            rows.append(("complete_pi", 0.0, nc, mc, M.ellippi(1 - mpf(nc), m)))
    write("elliptic", "function,phi,nc,mc,value", rows)


def jacobi():
    rows = []
    for mc in MC + [1e-100, 0.0]:
        mp.dps = 80 if mc > 1e-50 or mc == 0 else 180
        m = 1 - mpf(mc)
        for size in [0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 6.0, 6.0]:
            u = random.uniform(0.1, 1) * 10.0**size if size else random.choice([-1, 1]) * log_uniform(-9, 1)
            if mc == 0.0:
                if abs(u) > 300: continue
                sn, cn, dn = M.tanh(u), M.sech(u), M.sech(u)
                am = M.atan(M.sinh(mpf(u)))
            else:
                if mc < 1e-50 and size > 3: continue
                sn, cn, dn = [M.ellipfun(k, mpf(u), m=m) for k in ("sn", "cn", "dn")]
                n = M.nint(mpf(u) / (2 * M.ellipk(m)))
                sign = (-1) ** int(n)
                am = n * M.pi + M.atan2(sign * sn, sign * cn)
            assert abs(sn**2 + cn**2 - 1) < mpf(10) ** -60 and abs(dn**2 - cn**2 - mpf(mc) * sn**2) < mpf(10) ** -60
            rows.append((u, mc, sn, cn, dn, am))
    mp.dps = 80
    write("jacobi", "u,mc,sn,cn,dn,am", rows)


def kepler():
    rows = []
    for e in [0.0, 0.1, 0.3, 0.6, 0.8, 0.9, 0.99]:
        for mean in [0.0, 3.141592653589793, 1.0, -2.0] + [random.uniform(-3, 3) for _ in range(3)] + [log_uniform(-9, 0) for _ in range(4)] + [random.uniform(-1e4, 1e4)]:
            x = mpf(mean) - M.nint(mpf(mean) / (2 * M.pi)) * 2 * M.pi
            anomaly = M.findroot(lambda E: E - mpf(e) * M.sin(E) - x, (-M.pi - 1, M.pi + 1), solver="anderson", tol=1e-150)
            anomaly = M.findroot(lambda E: E - mpf(e) * M.sin(E) - x, anomaly, solver="newton", tol=1e-140)
            rows.append((mean, e, anomaly))
    write("kepler", "mean_anomaly,e,eccentric_anomaly", rows)


def arithmetic():
    random.seed(2)
    rows = []
    for i in range(24):
        x = random.choice([-1, 1]) * [random.uniform(0, 0.25), random.uniform(0, 7), random.uniform(7, 1e3), random.uniform(1e3, 1e6)][i % 4]
        rows += [("sin", x, 0.0, M.sin(mpf(x))), ("cos", x, 0.0, M.cos(mpf(x)))]
        x2 = [log_uniform(-16, -2), random.uniform(0, 0.0625), random.uniform(0.0625, 0.25), random.uniform(0.25, 1600)][i % 4]
        rows += [("cos_sqrt", x2, 0.0, M.cos(M.sqrt(mpf(x2)))), ("sinc_sqrt", x2, 0.0, M.sin(M.sqrt(mpf(x2))) / M.sqrt(mpf(x2)))]
        x = random.choice([-1, 1]) * [log_uniform(-9, 0), random.uniform(0, 5), random.uniform(5, 300)][i % 3]
        rows.append(("exp", x, 0.0, M.exp(mpf(x))))
        x = [log_uniform(-200, 200), 1 + random.choice([-1, 1]) * log_uniform(-12, -1), random.uniform(0, 10)][i % 3]
        rows.append(("ln", x, 0.0, M.log(mpf(x))))
        y, x = [random.choice([-1, 1]) * log_uniform(-9, 1) for _ in range(2)]
        rows.append(("atan2", y, x, M.atan2(mpf(y), mpf(x))))
    write("arithmetic", "function,x,y,value", rows)


for table in (elementary, carlson, elliptic, jacobi, kepler, arithmetic):
    table()

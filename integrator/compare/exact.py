"""The exact motions of the problems of this package, rounded to f64, as `src/exact.rs` has them.

    pip install mpmath && python3 exact.py

Kepler's equation, Jacobi's elliptic functions, and for the free body a Taylor series of 30 digits.
"""

from mpmath import atan2, cos, ellipf, ellipfun, findroot, mp, mpf, odefun, sin, sqrt

mp.dps = 40


def planet(t, mu=mpf(2), a=mpf("1.25"), e=mpf("0.4375"), anomaly=mpf("0.875")):
    n = sqrt(mu / a**3)
    mean = anomaly + n * t
    angle = findroot(lambda x: x - e * sin(x) - mean, mean)
    r, f = 1 - e * cos(angle), sqrt(1 - e * e)
    return [a * (cos(angle) - e), a * f * sin(angle), -a * n * sin(angle) / r, a * n * f * cos(angle) / r]


def swing(t, w0=sqrt(mpf("9.8125") / mpf("1.5")), angle=mpf("1.75"), omega=mpf("1.5")):
    s, p = sin(angle / 2), omega / (2 * w0)
    k = sqrt(s * s + p * p)
    u = w0 * t + ellipf(atan2(s, p), k * k)
    sn, cn, dn = (ellipfun(name, u, m=k * k) for name in ("sn", "cn", "dn"))
    return [2 * atan2(k * sn, dn), 2 * k * w0 * cn]


def spins(times, inertia=(mpf("1.25"), mpf("0.75"), mpf("1.75"))):
    a, b, c = inertia

    def rate(_t, y):
        w, x, y_, z, p, q, r = y
        return [
            -(x * p + y_ * q + z * r) / 2,
            (w * p + y_ * r - z * q) / 2,
            (w * q + z * p - x * r) / 2,
            (w * r + x * q - y_ * p) / 2,
            (b - c) / a * q * r,
            (c - a) / b * r * p,
            (a - b) / c * p * q,
        ]

    mp.dps = 30
    attitude = [mpf("0.5"), mpf("-0.75"), mpf(1), mpf("0.25")]
    norm = sqrt(sum(x * x for x in attitude))
    motion = odefun(rate, 0, [x / norm for x in attitude] + [mpf("1.5"), mpf("-0.75"), mpf(1)])
    return [motion(t) for t in times]


def show(name, times, rows):
    print(f"/// {name}: (t in s, y).")
    for t, row in zip(times, rows):
        print(f"    ({float(t)!r}, [{', '.join(repr(float(x)) for x in row)}]),")


SWING, PLANET, SPIN = (0, "2.75", 4, 88), (0, "2.25", 4, 72), (0, "2.25", 4, 72)
show("swing", SWING, [swing(mpf(t)) for t in SWING])
show("planet", PLANET, [planet(mpf(t)) for t in PLANET])
show("spin", SPIN, spins([mpf(t) for t in SPIN]))

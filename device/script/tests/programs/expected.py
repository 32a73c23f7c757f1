#!/usr/bin/env python3
"""Writes operators.txt, modifiers.txt and widths.txt beside this file: programs with the output that Python works out for them.

Run it by hand after a change of the language; the tests read what it wrote and need no Python.
"""
import math
import pathlib
import struct

HERE = pathlib.Path(__file__).parent
MASK = 0xFFFFFFFF


def signed(value, bits=32):
    value &= (1 << bits) - 1
    return value - (1 << bits) if value >> (bits - 1) else value


def single(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def truncated(a, b):
    quotient = abs(a) // abs(b)
    return quotient if (a < 0) == (b < 0) else -quotient


def shown(value, places=4):
    text = f"{value:.{places}f}".rstrip("0")
    text = text + "0" if text.endswith(".") else text
    return "0.0" if text == "-0.0" else text


UNSIGNED = [(100, 7), (7, 100), (4000000000, 3), (0, 5), (65537, 65536), (255, 255)]
SIGNED = [(-100, 7), (100, -7), (-7, -100), (-2147483648, 2), (5, -1)]


def digit(a, b):
    return abs(a) // 10 ** (b - 1) % 10 if 1 <= b <= 10 else 0


def shift(a, b, left):
    if not 0 <= b < 32:
        return 0
    a &= MASK
    return (a << b) & MASK if left else a >> b


TWO = {
    "DIG": lambda a, b: digit(a, b),
    "MAX": min,
    "MIN": max,
    "*": lambda a, b: a * b,
    "**": lambda a, b: (a * b) >> 32,
    "*/": lambda a, b: truncated(a * b, 65536),
    "/": truncated,
    "//": lambda a, b: a - truncated(a, b) * b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "<<": lambda a, b: shift(a, b, True),
    ">>": lambda a, b: shift(a, b, False),
    "<": lambda a, b: int(a < b),
    "<=": lambda a, b: int(a <= b),
    "=": lambda a, b: int(a == b),
    ">=": lambda a, b: int(a >= b),
    ">": lambda a, b: int(a > b),
    "<>": lambda a, b: int(a != b),
    "&": lambda a, b: a & b,
    "|": lambda a, b: a | b,
    "^": lambda a, b: a ^ b,
    "&/": lambda a, b: ~(a & b),
    "|/": lambda a, b: ~(a | b),
    "^/": lambda a, b: ~(a ^ b),
    "AND": lambda a, b: int(a != 0 and b != 0),
    "OR": lambda a, b: int(a != 0 or b != 0),
    "XOR": lambda a, b: int((a != 0) != (b != 0)),
}


def bcd(a):
    return sum((a // 10**place % 10) << (4 * place) for place in range(8))


def sine(angle):
    return max(-127, int(128 * math.sin(2 * math.pi * (angle % 256) / 256)))


ONE = {
    "NOT": (lambda a: int(a == 0), [0, 1, 77]),
    "ABS": (abs, [5, -5, -2147483647, 0]),
    "SIN": (sine, [0, 42, 64, 100, 128, 192, 255, 256]),
    "COS": (lambda a: sine(a + 64), [0, 42, 64, 100, 128, 192, 255, 256]),
    "-": (lambda a: -a, [5, -5, 0]),
    "SQR": (math.isqrt, [64, 220, 2200000, 4294967295, 0, 1]),
    "RANDOM": (lambda a: a * 1664525 + 1013904223, [0, 1, 123456]),
    "BIN2BCD": (bcd, [93, 0, 12345678, 99]),
    "~": (lambda a: ~a, [0, 1, 0xFFFF]),
    "!": (lambda a: ~a, [0, 1, 0xFFFF]),
}
FLOATS = {
    "FABS": (abs, [-1234.1234, 2.5]),
    "FSQRT": (math.sqrt, [2.0, 144.0]),
    "FSIN": (math.sin, [0.5, 1.5707963]),
    "FCOS": (math.cos, [0.0, 1.0]),
    "FTAN": (math.tan, [0.5, 0.7853981]),
    "FASIN": (math.asin, [1.0, 0.25]),
    "FACOS": (math.acos, [0.0, 0.25]),
    "FATAN": (math.atan, [1.0, 20.0]),
    "FSINH": (math.sinh, [0.6931472, 2.0]),
    "FCOSH": (math.cosh, [0.6931472, 2.0]),
    "FTANH": (math.tanh, [0.6931472, 2.0]),
    "FATANH": (math.atanh, [0.6, -0.5]),
    "FLN": (math.log, [2.0, 20.08]),
    "FEXP": (math.exp, [0.693115, 3.0]),
}
# Which operators take floats as well.
BOTH = ["MAX", "MIN", "*", "+", "-", "<", "<=", "=", ">=", ">", "<>", "AND", "OR", "XOR"]
FLOAT_PAIRS = [(2.5, 0.5), (-1.25, 4.0), (3.0, 3.0)]


def program(title, lines, output):
    return f"=== {title}\n" + "\n".join(lines) + f"\n---\n{output}\n"


def integer_lines(kind, pairs, operator, result):
    lines, output = [], []
    for a, b in pairs:
        if operator in ("/", "//") and b == 0:
            continue
        lines += [f"a = {a}", f"b = {b}", f"puts 0,[sdec a {operator} b,\" \"]"]
        output.append(str(signed(result(a, b))))
    return lines, output


def binary(operator, result):
    lines, output = ["a var long", "b var long", "c var slong", "d var slong"], []
    got = integer_lines("long", UNSIGNED, operator, result)
    lines, output = lines + got[0], output + got[1]
    for a, b in SIGNED:
        lines += [f"c = {a}", f"d = {b}", f"puts 0,[sdec c {operator} d,\" \"]"]
        output.append(str(signed(result(a, b))))
    if operator in BOTH or operator == "/":
        lines += ["f var float", "g var float"]
        for a, b in FLOAT_PAIRS:
            value = a / b if operator == "/" else result(a, b)
            how = "dec f {} g" if operator in BOTH[5:] else "real f {} g\\4"
            lines += [f"f = {a}", f"g = {b}", f"puts 0,[{how.format(operator)},\" \"]"]
            output.append(str(value) if operator in BOTH[5:] else shown(value))
    return program(operator, lines + ["end"], " ".join(output) + " ")


def unary(operator, result, values):
    lines, output = ["a var slong", "u var long"], []
    for value in values:
        name = "a" if value < 0 else "u"
        lines += [f"{name} = {value}", f"puts 0,[sdec {operator} {name},\" \"]"]
        output.append(str(signed(result(value))))
    return program(operator + " x" if operator == "-" else operator, lines + ["end"], " ".join(output) + " ")


def of_float(operator, result, values):
    lines, output = ["f var float"], []
    for value in values:
        lines += [f"f = {value}", f"puts 0,[real {operator} f\\4,\" \"]"]
        output.append(shown(single(result(single(value)))))
    return program(operator, lines + ["end"], " ".join(output) + " ")


def operators():
    page = [binary(operator, result) for operator, result in TWO.items()]
    page += [unary(operator, *rest) for operator, rest in ONE.items()]
    page += [of_float(operator, *rest) for operator, rest in FLOATS.items()]
    page.append(
        program(
            "TOINT",
            ["f var float", "f = 1231.99", "puts 0,[sdec toint f,\" \"]", "f = -2.99", "puts 0,[sdec toint f]", "end"],
            "1231 -2",
        )
    )
    page.append(
        program(
            "TOFLOAT",
            ["n var slong", "n = -3", "puts 0,[real tofloat n / 2.0,\" \"]", "n = 10", "puts 0,[real tofloat n / 100.0]", "end"],
            "-1.5 0.1",
        )
    )
    return page


BITS = {"Bit": 1, "Nib": 4, "Byte": 8, "SByte": 8, "Word": 16, "SWord": 16, "Long": 32, "SLong": 32}
PATTERN = 0x9C35F1A6


def modifiers():
    page = []
    for kind in ["Nib", "Byte", "SByte", "Word", "SWord", "Long", "SLong"]:
        for part in ["Bit", "Nib", "Byte", "SByte", "Word", "SWord"]:
            count = BITS[kind] // BITS[part]
            names = [f"{part}{index}" for index in range(count)]
            if count and not part.startswith("S"):
                names = [f"Low{part}", f"High{part}"] + names
            for name in names:
                if name.startswith("Low"):
                    index = 0
                elif name.startswith("High"):
                    index = count - 1
                else:
                    index = int(name[len(part):])
                width = BITS[part]
                whole = PATTERN & ((1 << BITS[kind]) - 1)
                value = (whole >> (index * width)) & ((1 << width) - 1)
                if part.startswith("S"):
                    value = signed(value, width)
                zeros = whole & ~(((1 << width) - 1) << (index * width))
                lines = [
                    f"v var {kind}",
                    f"l var {kind}(3)",
                    f"n var l(1).{name}",
                    f"v = 0x{whole:X}",
                    "l(1) = v",
                    f"puts 0,[sdec v.{name},\" \",sdec l(1).{name},\" \",sdec n,\" \"]",
                    f"v.{name} = 0",
                    "n = 0",
                    "puts 0,[sdec v,\" \",sdec l(1),\" \",sdec l(0),sdec l(2)]",
                    "end",
                ]
                left = signed(zeros, BITS[kind]) if kind.startswith("S") else signed(zeros)
                page.append(program(f"{kind}.{name}", lines, f"{value} {value} {value} {left} {left} 00"))
    return page


def kept(value, kind):
    value &= (1 << BITS[kind]) - 1
    return signed(value, BITS[kind]) if kind.startswith("S") else signed(value)


def widths():
    page = []
    values = [0, 1, 2, 15, 16, 127, 128, 255, 256, 32767, 32768, 65535, 65536, 2147483647, 2147483648, 4294967295, -1, -128, -32769]
    for kind in BITS:
        lines, output = [f"v var {kind}", f"l var {kind}(4)", "x var slong"], []
        for value in values:
            lines += [f"x = {value}", "v = x", "l(2) = x", "puts 0,[sdec v,\" \",sdec l(2),\" \"]"]
            output += [str(kept(value, kind))] * 2
        lines += ["puts 0,[sdec l(1),sdec l(3)]", "end"]
        page.append(program(kind, lines, " ".join(output) + " 00"))
        if kind in ("Bit", "Nib"):
            continue
        entries = [0, 1, 100, 127, -1, 5]
        shown_entries = " ".join(str(kept(entry, kind)) for entry in entries)
        puts = ",\" \",".join(f"sdec t({index})" for index in range(len(entries)))
        lines = [f"t {kind}Table " + ",".join(map(str, entries)), f"puts 0,[{puts},\" \"]", "i var byte"]
        lines += ["for i = 0 to 5", "puts 0,[sdec t(i)]", "next", "end"]
        page.append(program(f"{kind}Table", lines, shown_entries + " " + shown_entries.replace(" ", "")))
    page.append(
        program(
            "Float",
            ["f var float", "l var float(2)", "f = 1.0 / 3.0", "l(1) = 1.5e3 + 0.25", "puts 0,[real f,\" \",real l(1),\" \",real l(0)]", "end"],
            "0.33333334 1500.25 0.0",
        )
    )
    page.append(
        program("FloatTable", ["t FloatTable 1.5,-2.25,3.0", "puts 0,[real t(0),\" \",real t(1),\" \",real t(2)]", "end"], "1.5 -2.25 3.0")
    )
    return page


for name, page in [("operators", operators()), ("modifiers", modifiers()), ("widths", widths())]:
    head = "# Written by expected.py: programs and the output that Python works out for them.\n"
    (HERE / f"{name}.txt").write_text(head + "".join(page))

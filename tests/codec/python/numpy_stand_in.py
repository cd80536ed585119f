"""The little of numpy that qtet.simplify and Log.arrays use, for Pyodide without its wheels. It
shows where the bytes of arrays go, and computes nothing."""
import array
import math
import types

_CODES = {
    "float32": "f",
    "float64": "d",
    "int8": "b",
    "int16": "h",
    "int32": "i",
    "int64": "q",
    "uint8": "B",
    "uint16": "H",
    "uint32": "I",
    "uint64": "Q",
}


class dtype:
    def __init__(self, name):
        self.name, self.kind = name, name[0]

    def newbyteorder(self, _):
        return self


class ndarray:
    def __init__(self, values, kind, shape):
        self.values, self.dtype, self.shape = values, dtype(kind), tuple(shape)
        self.ndim, self.nbytes = len(self.shape), len(values) * values.itemsize
        self.ctypes = types.SimpleNamespace(data=values.buffer_info()[0])

    def __buffer__(self, _):
        return memoryview(self.values)

    def __len__(self):
        return self.shape[0]

    def reshape(self, *shape):
        shape = shape[0] if isinstance(shape[0], tuple) else shape
        rest = math.prod(n for n in shape if n != -1)
        shape = [len(self.values) // rest if n == -1 else n for n in shape]
        return ndarray(self.values, self.dtype.name, shape)

    def view(self, kind):
        return frombuffer(self.tobytes(), kind).reshape(*self.shape)

    def astype(self, kind, copy=True):
        if kind == self.dtype.name:
            return self
        cast = float if kind[0] == "f" else int
        values = array.array(_CODES[kind], map(cast, self.values))
        return ndarray(values, kind, self.shape)

    def tobytes(self):
        return self.values.tobytes()


def frombuffer(data, kind):
    values = array.array(_CODES[kind], bytes(data))
    return ndarray(values, kind, (len(values),))


def empty(shape, kind="float64"):
    shape = shape if isinstance(shape, tuple) else (shape,)
    values = array.array(_CODES[kind], [0]) * math.prod(shape)
    return ndarray(values, kind, shape)


def asarray(values):
    return values


def ascontiguousarray(values, dtype):
    return values.astype(dtype)


prod = math.prod
ma = types.SimpleNamespace(is_masked=lambda _: False, isMaskedArray=lambda _: False)

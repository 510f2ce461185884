"""Reads labeled triangle meshes, and computes what DiffusionNet knows of a surface: see diffusion_net.py.

A mesh is scaled to unit area around its centroid. Vertices at the same position are one, and vertices without a face are left
out. Files that cannot be used raise DataError: one line."""

import hashlib
import os
import pathlib
import tempfile
import zipfile

import numpy
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import eigsh

EIGENPAIRS = 128
DENSE_UP_TO = 400          # vertices; the sparse solver needs many more vertices than eigenpairs
SHIFT = -0.01              # of the shift-inverted Laplacian, whose smallest eigenvalue is 0
LEAST_AREA = 1e-6          # of a face, as a share of its longest edge squared: bounds the cotangents
LEAST_MASS = 1e-6          # of a vertex, as a share of the mean
LEAST_SPREAD = 1e-4        # of the edges of a vertex: below this share of the largest, a direction has no gradient
HKS_TIMES = numpy.logspace(-2, 0, 16)
MOST_HKS = 1000.0          # above that of every proper surface: bounds it on crumbs


class DataError(Exception):
    """A file, and what is wrong with it."""

    def __init__(self, path, problem):
        super().__init__(f"{path}: {problem}")


def read_text(path):
    try:
        return pathlib.Path(path).read_text()
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(path, getattr(error, "strerror", None) or "not a text file") from None


def write_atomically(path, write, mode="w"):
    """Calls write(file); the file appears at its place when it is complete."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}-", suffix=".tmp", dir=path.parent)
    try:
        with os.fdopen(handle, mode) as file:
            write(file)
        os.chmod(name, 0o644)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


def read_off(path):
    """Returns the positions and the faces of a triangle mesh."""
    numbers = [word for line in read_text(path).splitlines() for word in line.split("#")[0].split()]
    if not numbers or numbers[0] != "OFF":
        raise DataError(path, "not an OFF file")
    try:
        vertices, faces = int(numbers[1]), int(numbers[2])
        positions = numpy.array(numbers[4:4 + 3 * vertices], float).reshape(vertices, 3)
        rows = numpy.array(numbers[4 + 3 * vertices:4 + 3 * vertices + 4 * faces], int).reshape(faces, 4)
    except (ValueError, IndexError):
        raise DataError(path, "not a complete triangle mesh") from None
    if (rows[:, 0] != 3).any():
        raise DataError(path, "has faces that are not triangles")
    if faces == 0 or rows[:, 1:].min() < 0 or rows[:, 1:].max() >= vertices:
        raise DataError(path, "has no faces, or faces of vertices that it lacks")
    if not numpy.isfinite(positions).all():
        raise DataError(path, "has positions that are not finite")
    return positions, rows[:, 1:]


def labels_path(mesh):
    return mesh.with_name(mesh.stem + "_labels.txt")


def read_labels(path, faces):
    """Returns a name per face, "" for none, from pairs of lines: a name, then the 1-based numbers of its faces."""
    labels = numpy.full(faces, "", dtype=object)
    lines = [line.strip() for line in read_text(path).splitlines() if line.strip()]
    try:
        for name, numbers in zip(lines[::2], lines[1::2], strict=True):
            number = numpy.array(numbers.split(), int)
            if number.size and (number.min() < 1 or number.max() > faces):
                raise DataError(path, f"names faces that the mesh lacks ({faces} faces)")
            labels[number - 1] = name
    except ValueError:
        raise DataError(path, "not pairs of lines: a label, then the numbers of its faces") from None
    return labels


def write_labels(path, labels):
    """Writes such a file, complete or not at all."""
    def write(file):
        for name in sorted(set(labels) - {""}):
            file.write(f"{name}\n{' '.join(map(str, numpy.flatnonzero(labels == name) + 1))}\n")
    write_atomically(path, write)


def face_normals(positions, corners):
    """Returns a vector per face that is as long as twice its area."""
    a, b, c = (positions[corners[:, k]] for k in range(3))
    return numpy.cross(b - a, c - a)


def face_areas(positions, corners):
    return numpy.linalg.norm(face_normals(positions, corners), axis=1) / 2


def merged_vertices(positions, faces):
    """Returns one vertex per position that a face has, and the corners of the faces among these."""
    merged, corners = numpy.unique(positions[faces].reshape(-1, 3), axis=0, return_inverse=True)
    return merged, corners.reshape(-1, 3)


def with_unit_area(positions, corners):
    """Returns the positions scaled to a surface of area 1, around its centroid."""
    areas = face_areas(positions, corners)
    total = areas.sum()
    if not (total > 0 and numpy.isfinite(total)):
        raise ValueError("has no surface")
    centroid = areas @ positions[corners].mean(axis=1) / total
    return (positions - centroid) / numpy.sqrt(total)


def vertex_masses(positions, corners):
    """Returns a third of the area around each vertex."""
    areas = face_areas(positions, corners)
    mass = numpy.bincount(corners.ravel(), numpy.repeat(areas / 3, 3), len(positions))
    return numpy.maximum(mass, LEAST_MASS * mass.mean())


def cotangent_laplacian(positions, corners):
    """Returns the symmetric positive semidefinite matrix of the cotangent weights."""
    edges = [positions[corners[:, (k + 2) % 3]] - positions[corners[:, (k + 1) % 3]] for k in range(3)]  # opposite corner k
    longest = numpy.max([(edge ** 2).sum(axis=1) for edge in edges], axis=0)
    # One bound for the three cotangents of a face keeps its matrix positive semidefinite.
    twice_area = 2 * numpy.maximum(face_areas(positions, corners), LEAST_AREA * longest) + numpy.finfo(float).tiny
    laplacian = scipy.sparse.csr_matrix((len(positions), len(positions)))
    for k in range(3):
        i, j = corners[:, (k + 1) % 3], corners[:, (k + 2) % 3]
        weight = -(edges[(k + 1) % 3] * edges[(k + 2) % 3]).sum(axis=1) / twice_area / 2
        rows, columns = numpy.concatenate([i, j, i, j]), numpy.concatenate([j, i, i, j])
        values = numpy.concatenate([-weight, -weight, weight, weight])
        laplacian = laplacian + scipy.sparse.csr_matrix((values, (rows, columns)), laplacian.shape)
    return laplacian


def eigenpairs(laplacian, mass):
    """Returns the smallest eigenvalues, rising, and their eigenvectors, orthonormal with respect to the masses."""
    count = min(EIGENPAIRS, len(mass))
    if len(mass) <= DENSE_UP_TO:
        values, vectors = scipy.linalg.eigh(laplacian.toarray(), numpy.diag(mass), subset_by_index=[0, count - 1])
    else:
        start = numpy.random.RandomState(1).uniform(-1, 1, len(mass))  # else the result would differ from call to call
        values, vectors = eigsh(laplacian.tocsc(), count, scipy.sparse.diags(mass).tocsc(), sigma=SHIFT, v0=start)
    order = numpy.argsort(values)
    return numpy.maximum(values[order], 0), vectors[:, order]


def tangent_frames(positions, corners):
    """Returns two orthogonal unit vectors per vertex, normal to the mean of its faces' normals by area."""
    normal = numpy.zeros((len(positions), 3))
    of_face = face_normals(positions, corners)
    for k in range(3):
        numpy.add.at(normal, corners[:, k], of_face)
    length = numpy.linalg.norm(normal, axis=1, keepdims=True)
    normal = numpy.where(length > 0, normal / numpy.where(length > 0, length, 1), [0.0, 0, 1])
    axis = numpy.where(numpy.abs(normal[:, :1]) < 0.9, [1.0, 0, 0], [0.0, 1, 0])
    x = numpy.cross(axis, normal)
    x /= numpy.linalg.norm(x, axis=1, keepdims=True)
    return x, numpy.cross(normal, x)


def gradient(positions, corners):
    """Returns the two matrices that take values at vertices to the components of their gradients in the tangent frames.

    The gradient at a vertex fits the differences along its edges in the sense of least squares."""
    pairs = numpy.concatenate([corners[:, [a, b]] for a in range(3) for b in range(3) if a != b])
    tail, tip = numpy.unique(pairs[pairs[:, 0] != pairs[:, 1]], axis=0).T
    x, y = tangent_frames(positions, corners)
    edge = positions[tip] - positions[tail]
    flat = numpy.stack([(edge * x[tail]).sum(axis=1), (edge * y[tail]).sum(axis=1)], axis=1)
    spread = numpy.zeros((len(positions), 2, 2))
    numpy.add.at(spread, tail, flat[:, :, None] * flat[:, None, :])
    weights = numpy.einsum("eij,ej->ei", numpy.linalg.pinv(spread, rcond=LEAST_SPREAD, hermitian=True)[tail], flat)
    every = numpy.arange(len(positions))
    rows, columns = numpy.concatenate([tail, every]), numpy.concatenate([tip, every])
    return [scipy.sparse.csr_matrix((numpy.concatenate([weight, -numpy.bincount(tail, weight, len(every))]), (rows, columns)))
            for weight in weights.T]


def heat_kernel_signatures(eigenvalues, eigenvectors):
    return numpy.minimum(eigenvectors ** 2 @ numpy.exp(-numpy.outer(eigenvalues, HKS_TIMES)), MOST_HKS)


class Surface:
    """Arrays of a mesh. The gradients are those of the eigenvectors: all that is derived is a sum of these."""

    NAMES = ("positions", "corners", "areas", "mass", "eigenvalues", "eigenvectors")

    def __init__(self, arrays):
        self.positions, self.corners, self.areas, self.mass, self.eigenvalues, self.eigenvectors = (
            arrays[name] for name in self.NAMES)
        size = (len(self.mass), len(self.mass))
        self.gradient_x, self.gradient_y = (
            scipy.sparse.csr_matrix((arrays[f"gradient_{axis}"], arrays["columns"], arrays["rows"]), size) @ self.eigenvectors
            for axis in "xy")
        self.hks = heat_kernel_signatures(self.eigenvalues, self.eigenvectors).astype("f4")

    @staticmethod
    def arrays_of(positions, faces):
        """Computes what a surface is made from, in single precision."""
        positions, corners = merged_vertices(positions, faces)
        positions = with_unit_area(positions, corners)
        mass = vertex_masses(positions, corners)
        eigenvalues, eigenvectors = eigenpairs(cotangent_laplacian(positions, corners), mass)
        gradient_x, gradient_y = gradient(positions, corners)
        arrays = {"positions": positions, "areas": face_areas(positions, corners), "mass": mass, "eigenvalues": eigenvalues,
                  "eigenvectors": eigenvectors, "gradient_x": gradient_x.data, "gradient_y": gradient_y.data}
        if not all(numpy.isfinite(array).all() for array in arrays.values()):
            raise ValueError("its Laplacian has no finite eigenvectors")
        return {name: array.astype("f4") for name, array in arrays.items()} | {
            "corners": corners.astype("i4"), "columns": gradient_x.indices.astype("i4"), "rows": gradient_x.indptr.astype("i4")}

    @staticmethod
    def of(path, work):
        """Reads a mesh; computes its arrays unless the folder 'work' has them from an earlier call."""
        positions, faces = read_off(path)
        kept = work / f"{path.stem}-{hashlib.sha256(positions.tobytes() + faces.tobytes()).hexdigest()[:16]}.npz"
        if not kept.exists():
            try:
                arrays = Surface.arrays_of(positions, faces)
            except (ValueError, ArithmeticError, RuntimeError, numpy.linalg.LinAlgError) as error:
                raise DataError(path, str(error).splitlines()[0]) from None
            write_atomically(kept, lambda file: numpy.savez(file, **arrays), mode="wb")
        try:
            with numpy.load(kept) as arrays:
                return Surface(arrays)
        except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile):
            raise DataError(kept, "cannot be read; remove it") from None

#!/usr/bin/env python3
"""DiffusionNet: its Laplacian, its gradients, and labels of generated dumbbells; see diffusion_net.py.

    diffusion_net_test.py

Exit code 77 says that the test was skipped, and why."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

import programs

EPOCHS = 10


def icosphere(levels):
    """Returns an icosahedron whose faces are split so many times, on the unit sphere."""
    golden = (1 + 5 ** 0.5) / 2
    positions = numpy.array([[0, s, t * golden] for s in (-1, 1) for t in (-1, 1)])
    positions = numpy.concatenate([numpy.roll(positions, k, axis=1) for k in range(3)])
    faces = scipy.spatial.ConvexHull(positions).simplices
    for _ in range(levels):  # both faces of an edge find the same middle, to the last bit
        corners = positions[faces]
        middles = (corners + corners[:, [1, 2, 0]]) / 2
        parts = [numpy.stack([corners[:, k], middles[:, k], middles[:, (k + 2) % 3]], axis=1) for k in range(3)]
        positions, faces = surfaces.merged_vertices(numpy.concatenate([*parts, middles]).reshape(-1, 3),
                                                    numpy.arange(12 * len(faces)).reshape(-1, 3))
    positions = positions / numpy.linalg.norm(positions, axis=1, keepdims=True)
    outward = (surfaces.face_normals(positions, faces) * positions[faces].mean(axis=1)).sum(axis=1) > 0
    return positions, numpy.where(outward[:, None], faces, faces[:, ::-1])


def plane(random, side=12):
    """Returns a grid of random heights and widths, and its faces."""
    x, y = (numpy.sort(random.uniform(size=side)) for _ in range(2))
    positions = numpy.stack([*numpy.meshgrid(x, y), numpy.zeros((side, side))], axis=-1).reshape(-1, 3)
    corner = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    return positions, numpy.concatenate([numpy.stack([corner, corner + 1, corner + side + 1], axis=1),
                                         numpy.stack([corner, corner + side + 1, corner + side], axis=1)])


def turned(positions, seed):
    return positions @ Rotation.random(random_state=seed).as_matrix().T


def dumbbell(seed, rings=28, around=16):
    """Returns positions, faces and labels: a ball at one end of a rod, somewhere in space."""
    random = numpy.random.RandomState(seed)
    radius, length, rod = random.uniform(0.8, 1.2), random.uniform(2, 3), random.uniform(0.2, 0.3)
    z = numpy.linspace(-radius, length, rings)
    profile = numpy.maximum(numpy.sqrt(numpy.maximum(radius ** 2 - z ** 2, 0)), numpy.where(z > 0, rod, 0.05))
    angle = 2 * numpy.pi * numpy.arange(around) / around
    ring = profile[:, None] * (1 + 0.05 * random.uniform(size=(rings, around)))
    positions = numpy.stack([ring * numpy.cos(angle), 0.8 * ring * numpy.sin(angle),
                             numpy.repeat(z[:, None], around, axis=1)], axis=-1).reshape(-1, 3)
    a = (numpy.arange(rings - 1)[:, None] * around + numpy.arange(around)).ravel()
    b = (numpy.arange(rings - 1)[:, None] * around + (numpy.arange(around) + 1) % around).ravel()
    faces = numpy.concatenate([numpy.stack([a, b, b + around], axis=1), numpy.stack([a, b + around, a + around], axis=1)])
    is_ball = positions[faces][:, :, 2].mean(axis=1) < radius
    return turned(positions, seed), faces, numpy.where(is_ball, "ball", "rod").astype(object)


def write_mesh(path, positions, faces, labels):
    rows = [" ".join(map(repr, point)) for point in positions.tolist()] + ["3 {} {} {}".format(*face) for face in faces]
    path.write_text("\n".join(["OFF", f"{len(positions)} {len(faces)} 0", *rows]) + "\n")
    surfaces.write_labels(surfaces.labels_path(path), labels)


def network(kind="hks", labels=3):
    """Returns a network with random weights, whose diffusions are felt."""
    torch.manual_seed(1)
    result = diffusion_net.Network({"hks": 16, "xyz": 3}[kind], labels).eval()
    with torch.no_grad():
        for block in result.blocks:
            block.time.uniform_(0.001, 0.1)
    return result


def scores(positions, faces, kind="hks"):
    """Returns the scores of the faces by a network with random weights."""
    shape = diffusion_net.Shape(surfaces.Surface(surfaces.Surface.arrays_of(positions, faces)), kind)
    with torch.no_grad():
        return shape.face_scores(network(kind), shape.features).numpy()


class SurfaceTest(unittest.TestCase):
    def test_eigenvalues_of_the_sphere(self):
        arrays = surfaces.Surface.arrays_of(*icosphere(3))
        of_unit_sphere = arrays["eigenvalues"][:9] / (4 * numpy.pi)
        self.assertLess(numpy.abs(of_unit_sphere - [0, 2, 2, 2, 6, 6, 6, 6, 6]).max(), 0.1)
        vectors = arrays["eigenvectors"]
        self.assertTrue(numpy.allclose(numpy.eye(128), (vectors.T * arrays["mass"]) @ vectors, atol=1e-4))

    def test_few_and_many_vertices_have_the_same_eigenvalues(self):
        positions, faces = icosphere(3)
        positions = positions * [1, 1.2, 1.5]
        laplacian, mass = surfaces.cotangent_laplacian(positions, faces), surfaces.vertex_masses(positions, faces)
        sparse = surfaces.eigenpairs(laplacian, mass)[0]
        dense = scipy.linalg.eigh(laplacian.toarray(), numpy.diag(mass), eigvals_only=True)[:len(sparse)]
        self.assertTrue(numpy.allclose(dense, sparse, rtol=1e-6, atol=1e-9))

    def test_gradients_of_linear_functions_are_exact(self):
        positions, faces = plane(numpy.random.RandomState(1))
        slope = numpy.array([3.0, -2, 0])
        positions, slope = turned(positions, 2), turned(slope, 2)
        x, y = surfaces.tangent_frames(positions, faces)
        along_x, along_y = (matrix @ (positions @ slope + 5) for matrix in surfaces.gradient(positions, faces))
        self.assertTrue(numpy.allclose(slope, along_x[:, None] * x + along_y[:, None] * y, atol=1e-9))

    def test_a_damaged_mesh_has_finite_scores(self):
        positions, faces, _ = dumbbell(1)
        extra = numpy.array([[9.0, 9, 9], [5, 5, 5], [5, 5, 6], [5, 6, 5], positions[3], [7, 7, 7]])
        n = len(positions)  # a vertex without face, a piece of its own, a vertex that is there twice, a face of one point
        damage = [[n + 1, n + 2, n + 3], [0, 1, n + 4], [0, 1, 40], [0, 1, 41], [5, 5, 6], [n + 5] * 3, [0, 17, 0]]
        positions, faces = numpy.concatenate([positions, extra]), numpy.concatenate([faces, damage])
        for kind in ("hks", "xyz"):
            found = scores(positions, faces, kind)
            self.assertEqual((len(faces), 3), found.shape)
            self.assertTrue(numpy.isfinite(found).all())

    def test_one_face_is_enough(self):
        self.assertTrue(numpy.isfinite(scores(numpy.eye(3), numpy.array([[0, 1, 2]]))).all())


class NetworkTest(unittest.TestCase):
    def test_scores_stay_when_the_mesh_is_turned_moved_and_scaled(self):
        positions, faces, _ = dumbbell(1)
        straight = scores(positions, faces)
        self.assertGreater(numpy.ptp(straight[:, 0]), 0.01)
        self.assertTrue(numpy.allclose(straight, scores(7 * turned(positions, 5) + [1, 2, 3], faces), atol=1e-3))

    def test_scores_of_coordinates_do_not(self):
        positions, faces, _ = dumbbell(1)
        self.assertFalse(numpy.allclose(scores(positions, faces, "xyz"), scores(turned(positions, 5), faces, "xyz"), atol=1e-2))

    def test_scores_go_with_the_faces(self):
        positions, faces, _ = dumbbell(1)
        random = numpy.random.RandomState(1)
        place, order = random.permutation(len(positions)), random.permutation(len(faces))
        moved = numpy.empty_like(positions)
        moved[place] = positions
        self.assertTrue(numpy.allclose(scores(positions, faces)[order], scores(moved, place[faces][order]), atol=1e-5))

    def test_some_vertices_give_the_coefficients_of_all(self):
        positions, faces = icosphere(4)
        shape = diffusion_net.Shape(surfaces.Surface(surfaces.Surface.arrays_of(positions, faces)), "hks")
        truth = torch.linspace(1, -1, 128)[:, None]
        vertices = torch.from_numpy(numpy.random.RandomState(1).choice(len(positions), 1000))
        for points in (shape.points, diffusion_net.points_at(shape.points, vertices)):
            self.assertLess((points.projection @ (points.basis @ truth) - truth).abs().max(), 0.02)

    def test_faces_count_by_their_area_unless_they_have_no_label(self):
        positions, faces, labels = dumbbell(1)
        target = numpy.where(labels == "ball", 0, 1)
        target[::3] = -1
        surface = surfaces.Surface(surfaces.Surface.arrays_of(positions, faces))
        shape = diffusion_net.Shape(surface, "hks", target)
        with torch.no_grad():
            loss = shape.loss(network(), numpy.random.RandomState(1), None).item()
            logs = torch.log_softmax(shape.face_scores(network(), shape.features), dim=1).numpy()
        known = target >= 0
        expected = -(surface.areas[known] @ logs[known, target[known]]) / surface.areas[known].sum()
        self.assertAlmostEqual(expected, loss, 4)

    def test_the_loss_at_some_vertices_is_about_that_of_all(self):
        positions, faces, labels = dumbbell(1)
        shape = diffusion_net.Shape(surfaces.Surface(surfaces.Surface.arrays_of(positions, faces)), "hks",
                                    numpy.where(labels == "ball", 0, 1))
        random = numpy.random.RandomState(1)
        with torch.no_grad():
            whole = shape.loss(network(), random, None).item()
            some = numpy.mean([shape.sampled_loss(network(), random, 400).item() for _ in range(20)])
        self.assertLess(abs(whole - some), 0.1 * whole)


class LabelingTest(unittest.TestCase):
    """Four dumbbells to learn from, two to label."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="exemplar-compare-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.shapes = self.folder / "shapes"
        self.shapes.mkdir()
        for seed in range(6):
            write_mesh(self.shapes / f"{seed}.off", *dumbbell(seed))
        self.report = self.folder / "report.json"
        self.write_report({"categories": [{"category": "Dumbbell", "splits": [
            {"split": "sb6-0", "train": ["0", "1", "2", "3"],
             "meshes": [{"path": str(self.shapes / f"{seed}.off")} for seed in (4, 5)]}]}]})

    def write_report(self, content):
        self.report.write_text(json.dumps(content))

    def call(self, *options, out="peer"):
        """Returns what the program prints."""
        with contextlib.redirect_stderr(io.StringIO()) as said:
            diffusion_net.main([str(self.report), "--out", str(self.folder / out), *options])
        return said.getvalue()

    def label_file(self, seed, out="peer"):
        return self.folder / out / "Dumbbell" / f"{seed}_labels.txt"

    def wrong(self, seed, out="peer"):
        """Returns the share of the surface that is not labeled as the truth."""
        positions, faces, truth = dumbbell(seed)
        areas = surfaces.face_areas(positions, faces)
        return areas[surfaces.read_labels(self.label_file(seed, out), len(faces)) != truth].sum() / areas.sum()

    def failure(self, *options):
        with self.assertRaises(SystemExit) as raised:
            self.call(*options)
        message = str(raised.exception.code)
        self.assertRegex(message, "^error: ")
        self.assertNotIn("\n", message)
        return message

    def test_balls_and_rods_are_learned(self):
        for options in ([], ["--points", "300"], ["--input", "xyz", "--epochs", "40"]):
            with self.subTest(options=options):
                out = "-".join(["peer", *options])
                self.call("--epochs", str(EPOCHS), *options, out=out)
                for seed in (4, 5):
                    self.assertLess(self.wrong(seed, out), 0.05)

    def test_equal_seeds_give_equal_files(self):
        for options in ([], ["--points", "300"]):
            contents = []
            for out in ("one", "two"):
                self.call("--epochs", "2", *options, out="".join([out, *options]))
                record = json.loads((self.folder / "".join([out, *options]) / "Dumbbell" / "training.json").read_text())
                contents.append((self.label_file(4, "".join([out, *options])).read_bytes(), record["loss"]))
            self.assertEqual(*contents)
        self.call("--epochs", "2", "--seed", "2", out="three")
        self.assertNotEqual(contents[0][1], json.loads((self.folder / "three/Dumbbell/training.json").read_text())["loss"])

    def test_what_is_there_is_not_learned_again(self):
        self.assertIn("labeled now: 1 of 1", self.call("--epochs", "1"))
        before = self.label_file(4).stat().st_mtime_ns
        self.assertIn("labeled now: 0 of 1", self.call("--epochs", "1"))
        self.assertEqual(before, self.label_file(4).stat().st_mtime_ns)
        content = self.label_file(5).read_bytes()
        self.label_file(5).unlink()
        self.assertIn("labeled now: 1 of 1", self.call("--epochs", "1"))
        self.assertEqual(content, self.label_file(5).read_bytes())
        self.assertIn("other options", self.failure("--epochs", "2"))

    def test_every_face_has_one_label_and_no_other_file_is_left(self):
        self.call("--epochs", "1")
        lines = self.label_file(4).read_text().splitlines()
        self.assertLessEqual(set(lines[::2]), {"ball", "rod"})
        faces = sorted(int(number) for line in lines[1::2] for number in line.split())
        self.assertEqual(list(range(1, len(dumbbell(4)[1]) + 1)), faces)
        self.assertEqual(["4_labels.txt", "5_labels.txt", "training.json"],
                         sorted(path.name for path in self.label_file(4).parent.iterdir()))

    def test_a_broken_report_gives_one_line(self):
        self.assertIn("no category Cup", self.failure("--category", "Cup"))
        self.assertIn("no split 1", self.failure("--split", "1"))
        for broken in ({"meshes": []}, [1, 2], {"categories": [{"category": "Dumbbell"}]}, {"categories": 3}):
            self.write_report(broken)
            self.assertIn("not a report", self.failure())
        self.report.write_text("{")
        self.assertIn("not JSON", self.failure())
        self.report.unlink()
        self.assertIn("No such file", self.failure())

    def test_a_broken_mesh_gives_one_line(self):
        mesh, labels = self.shapes / "2.off", self.shapes / "2_labels.txt"
        content = mesh.read_text()
        for broken, problem in ((content[:300], "not a complete triangle mesh"), ("ply\n", "not an OFF file"),
                                ("OFF\n3 1 0\n0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n", "has no surface"),
                                ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "lacks")):
            mesh.write_text(broken)
            self.assertIn(f"{mesh}: ", self.failure())
            self.assertIn(problem, self.failure())
        mesh.write_text(content)
        for broken, problem in (("ball\n1 2\nrod\n", "pairs of lines"), ("ball\n99999\n", "lacks")):
            labels.write_text(broken)
            self.assertIn(problem, self.failure())
        mesh.unlink()
        self.assertIn(f"{mesh}: No such file", self.failure())


if __name__ == "__main__":
    programs.require_compare()
    try:
        import diffusion_net  # before numpy: it sets the number of threads
    except ImportError as error:
        print(f"skipped: {sys.executable} lacks a package (Debian: python3-torch, python3-scipy): {error}")
        sys.exit(programs.SKIPPED)
    import numpy
    import scipy.linalg
    import scipy.spatial
    import surfaces
    import torch
    from scipy.spatial.transform import Rotation
    unittest.main()

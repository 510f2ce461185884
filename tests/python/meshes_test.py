"""Meshes: arrays in and out, files, validation, errors."""

import gc
import os
import pathlib
import unittest

import numpy as np

import exemplar
from shapes import CUBE, CUBE_FACES, CUBE_QUADS, PackageTest, sphere


class ArraysTest(PackageTest):
    def test_arrays_come_back(self):
        mesh = exemplar.Mesh(CUBE, CUBE_FACES)
        np.testing.assert_array_equal(mesh.vertices, CUBE)
        np.testing.assert_array_equal(mesh.faces, CUBE_FACES)
        self.assertEqual((mesh.vertices.dtype, mesh.faces.dtype), (np.float32, np.uint32))
        self.assertEqual((mesh.vertex_count, mesh.face_count, mesh.source_face_count), (8, 12, 12))
        self.assertEqual(repr(mesh), "<exemplar.Mesh 'mesh': 8 vertices, 12 faces>")
        np.testing.assert_array_equal(mesh.source_faces, np.arange(12))

    def test_views_are_of_the_same_memory_and_keep_it_alive(self):
        mesh = exemplar.Mesh(CUBE, CUBE_FACES)
        self.assertTrue(np.shares_memory(mesh.vertices, mesh.vertices))
        self.assertTrue(np.shares_memory(mesh.faces, mesh.with_labels([0] * 12, ["all"]).faces))
        vertices, faces = mesh.vertices, mesh.faces
        del mesh
        gc.collect()
        spoiled = [exemplar.Mesh(CUBE + 5, CUBE_FACES) for _ in range(100)]  # would take freed memory
        np.testing.assert_array_equal(vertices, CUBE)
        np.testing.assert_array_equal(faces, CUBE_FACES)
        del spoiled

    def test_views_cannot_be_written(self):
        mesh = exemplar.Mesh(CUBE, CUBE_FACES).with_labels([0] * 12, ["all"])
        for array in (mesh.vertices, mesh.faces, mesh.labels, mesh.face_areas()):
            with self.assertRaises(ValueError):
                array[0] = 0
            with self.assertRaises(ValueError):
                array.setflags(write=True)

    def test_given_arrays_are_copied(self):
        given = CUBE.copy()
        mesh = exemplar.Mesh(given, CUBE_FACES)
        given[:] = 7
        np.testing.assert_array_equal(mesh.vertices, CUBE)

    def test_takes_all_real_numbers_and_layouts(self):
        for vertices in (CUBE.tolist(), CUBE.astype(float), CUBE.astype(int), np.asfortranarray(CUBE),
                         np.repeat(CUBE, 2, axis=0)[::2], CUBE.astype(">f4")):
            np.testing.assert_array_equal(exemplar.Mesh(vertices, CUBE_FACES).vertices, CUBE)
        for faces in (CUBE_FACES.tolist(), CUBE_FACES.astype(np.uint8), CUBE_FACES.astype(np.uint64),
                      np.asfortranarray(CUBE_FACES)):
            np.testing.assert_array_equal(exemplar.Mesh(CUBE, faces).faces, CUBE_FACES)

    def test_refuses_other_values(self):
        for vertices in ("cube", None, [["a", "b", "c"]], CUBE.astype(complex), [[1, 2, 3], [4, 5]], object()):
            with self.subTest(vertices=vertices):
                self.raises(TypeError, "vertices: an array of numbers is needed", exemplar.Mesh, vertices, CUBE_FACES)
        for faces in (CUBE_FACES.astype(float), "faces", CUBE_FACES > 0):
            with self.subTest(faces=faces):
                self.raises(TypeError, "faces: an array of whole numbers is needed", exemplar.Mesh, CUBE, faces)

    def test_refuses_other_shapes(self):
        for vertices in (CUBE[:, :2], CUBE.ravel(), CUBE[None], 3.0):
            self.raises(exemplar.UsageError, "vertices: an array of shape (N, 3) is needed", exemplar.Mesh, vertices,
                        CUBE_FACES)
        self.raises(ValueError, "faces: an array of shape (N, 3) is needed, not (6, 4)", exemplar.Mesh, CUBE, CUBE_QUADS)

    def test_refuses_vertices_that_are_not_there(self):
        for wrong in (8, -1, 2**32, 2**63 - 1, -2**63):
            faces = CUBE_FACES.astype(np.int64)
            faces[3, 1] = wrong
            self.raises(exemplar.UsageError, ["faces: row 3 has", "numbered from 0 to 7"], exemplar.Mesh, CUBE, faces)
        faces = CUBE_FACES.astype(np.uint64)
        faces[3, 1] = 2**64 - 1
        self.raises(exemplar.UsageError, "faces: row 3", exemplar.Mesh, CUBE, faces)

    def test_labels(self):
        plain = exemplar.Mesh(CUBE, CUBE_FACES)
        self.assertIsNone(plain.labels)
        self.assertEqual(plain.label_names, [])
        labels = np.arange(12) % 3 - 1
        mesh = plain.with_labels(labels, ["one", "two"], np.linspace(0, 1, 12))
        np.testing.assert_array_equal(mesh.labels, labels)
        self.assertEqual(mesh.labels.dtype, np.int32)
        self.assertEqual(mesh.label_names, ["one", "two"])
        np.testing.assert_allclose(mesh.confidence, np.linspace(0, 1, 12), rtol=1e-6)
        self.raises(exemplar.UsageError, "labels: row 2 has 2", plain.with_labels, [0, 1, 2] * 4, ["one", "two"])
        self.raises(exemplar.UsageError, "labels", plain.with_labels, [0, 1], ["one", "two"])
        self.raises(exemplar.UsageError, "labels", plain.with_labels, [], ["one"])
        self.raises(TypeError, "labels", plain.with_labels, [0.5] * 12, ["one"])

    def test_measures(self):
        mesh = exemplar.Mesh(CUBE, CUBE_FACES)
        np.testing.assert_allclose(mesh.face_areas(), 0.5)
        np.testing.assert_allclose(mesh.face_normals()[:2], [(0, 0, -1)] * 2)
        np.testing.assert_allclose(mesh.face_centers()[0], CUBE[CUBE_FACES[0]].mean(axis=0), rtol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(mesh.vertex_normals(), axis=1), 1, rtol=1e-6)

    def test_simplified(self):
        mesh = exemplar.Mesh(*sphere(40))
        simple, face_of = mesh.simplified(500)
        self.assertLess(abs(simple.face_count - 500), 100)
        self.assertEqual(face_of.shape, (mesh.face_count,))
        self.assertLess(face_of.max(), simple.face_count)
        self.raises(exemplar.UsageError, "faces: 0", mesh.simplified, 0)
        self.raises(exemplar.MeshError, "mesh", exemplar.Mesh([], []).simplified, 100)


class ValidationTest(PackageTest):
    def test_a_clean_mesh(self):
        report = exemplar.Mesh(CUBE, CUBE_FACES).validate()
        self.assertTrue(report.clean and report.usable)
        self.assertEqual((report.messages, report.boundary_edges, report.components), ([], 0, 1))

    def test_what_is_wrong_and_where(self):
        vertices = np.concatenate([CUBE, [(9, 9, 9), (np.nan, 0, 0)]])
        faces = np.concatenate([CUBE_FACES, [(0, 2, 3), (4, 4, 5)]])
        report = exemplar.Mesh(vertices, faces).validate()
        self.assertFalse(report.clean or report.usable)
        np.testing.assert_array_equal(report.duplicate_faces, [12])
        np.testing.assert_array_equal(report.degenerate_faces, [13])
        np.testing.assert_array_equal(report.unreferenced_vertices, [8, 9])
        np.testing.assert_array_equal(report.non_finite_vertices, [9])
        self.assertIn([0, 2], report.non_manifold_edges.tolist())
        self.assertEqual(report.non_manifold_edges.shape[1], 2)
        self.assertTrue(any("not finite" in message for message in report.messages))

    def test_orientation_and_emptiness(self):
        self.assertTrue(exemplar.Mesh(CUBE, CUBE_FACES[:, ::-1]).validate().inside_out)
        turned = CUBE_FACES.copy()
        turned[0] = turned[0, ::-1]
        self.assertEqual(len(exemplar.Mesh(CUBE, turned).validate().inconsistent_edges), 3)
        self.assertEqual(exemplar.Mesh(CUBE, CUBE_FACES[1:]).validate().boundary_edges, 3)
        for empty in (exemplar.Mesh([], []), exemplar.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)),
                      exemplar.Mesh(CUBE, [])):
            self.assertTrue(empty.validate().empty)
            self.assertEqual(empty.faces.shape, (0, 3))


class FilesTest(PackageTest):
    def test_formats_come_back(self):
        mesh = exemplar.Mesh(CUBE, CUBE_FACES)
        for name in ("cube.off", "cube.obj", "cube.ply", "cube.glb"):
            path = self.folder / name
            mesh.write(path)
            mesh.write(str(path))
            again = exemplar.read_mesh(path)
            np.testing.assert_array_equal(again.vertices, CUBE, name)
            np.testing.assert_array_equal(again.faces, CUBE_FACES, name)
            self.assertEqual(again.name, str(path))
        self.raises(exemplar.UsageError, ["cube.stl", "'.stl' is not written"], mesh.write, self.folder / "cube.stl")
        self.raises(exemplar.DataError, "/proc/nothing", mesh.write, "/proc/nothing/cube.off")

    def test_labels_come_back(self):
        labels = np.arange(12) % 2
        mesh = exemplar.Mesh(CUBE, CUBE_FACES).with_labels(labels, ["even", "odd"], np.full(12, 0.25))
        mesh.write(self.folder / "labeled.ply")
        again = exemplar.read_mesh(self.folder / "labeled.ply")
        np.testing.assert_array_equal(again.labels, labels)
        self.assertEqual(again.label_names, ["even", "odd"])
        np.testing.assert_array_equal(again.confidence, 0.25)
        mesh.write(self.folder / "text.off")
        mesh.write_labels(self.folder / "text_labels.txt")
        for sources in (self.folder / "text.off", [str(self.folder / "text.off"), self.folder / "text.off"]):
            [read] = exemplar.read_labeled(sources)
            np.testing.assert_array_equal(read.labels, labels)
            self.assertEqual(read.label_names, ["even", "odd"])
        self.raises(exemplar.UsageError, "has no labels", exemplar.Mesh(CUBE, CUBE_FACES).write_labels, "x.txt")
        self.raises(exemplar.DataError, "cube", exemplar.read_labeled, self.folder / "no-cube")

    def test_polygons_are_cut_into_triangles(self):
        path = self.folder / "quads.off"
        rows = [" ".join(map(str, vertex)) for vertex in CUBE] + [" ".join(map(str, (4, *q))) for q in CUBE_QUADS]
        path.write_text("OFF\n8 6 0\n" + "\n".join(rows) + "\n")
        mesh = exemplar.read_mesh(path)
        self.assertEqual((mesh.face_count, mesh.source_face_count), (12, 6))
        np.testing.assert_array_equal(mesh.source_faces, np.repeat(np.arange(6), 2))
        labeled = mesh.with_labels(np.repeat([0, 1], 6), ["a", "b"])
        labeled.write_labels(self.folder / "quads_labels.txt")
        self.assertEqual((self.folder / "quads_labels.txt").read_text().split("\n")[1], "1 2 3")
        [again] = exemplar.read_labeled(path)
        np.testing.assert_array_equal(again.labels, labeled.labels)

    def test_errors_of_files(self):
        self.raises(exemplar.MeshError, "missing.off", exemplar.read_mesh, self.folder / "missing.off")
        bad = self.folder / "bad.off"
        bad.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n")
        self.raises(exemplar.MeshError, [str(bad) + ":6"], exemplar.read_mesh, bad)
        self.raises(exemplar.MeshError, "mesh.xyz", exemplar.read_mesh, pathlib.Path("mesh.xyz"))
        with self.assertRaises(TypeError):
            exemplar.read_mesh(3)

    def test_names_of_any_encoding(self):
        path = os.fsencode(self.folder) + b"/gr\xfcn.off"
        with self.assertRaises(exemplar.MeshError) as caught:
            exemplar.read_mesh(path)
        self.assertIn("gr\ufffdn.off", str(caught.exception))
        exemplar.Mesh(CUBE, CUBE_FACES).write(os.fsdecode(path))
        mesh = exemplar.read_mesh(path)
        self.assertIn("gr\ufffdn.off", mesh.name)
        self.assertIn("gr\ufffdn.off", repr(mesh))


class ErrorsTest(unittest.TestCase):
    def test_classes_are_related_as_in_the_library(self):
        for name in ("MeshError", "DataError", "ModelError", "DeviceError", "ShaderError", "UsageError"):
            self.assertIs(getattr(exemplar, name).__mro__[1], exemplar.Error, name)
        for name in ("NoDeviceError", "DeviceLostError", "DeviceLimitError", "DeviceMemoryError"):
            self.assertIs(getattr(exemplar, name).__bases__[0], exemplar.DeviceError, name)
        self.assertTrue(issubclass(exemplar.UsageError, ValueError))
        self.assertEqual(exemplar.MeshError.__module__, "exemplar")
        self.assertEqual(exemplar.Mesh.__module__, "exemplar")


class SynthTest(PackageTest):
    def test_shapes_are_those_of_the_program(self):
        self.program("synth", "cup", "--seed", 3, "--faces", 800, "--out", "synth")
        made = exemplar.make_shape("cup", seed=3, faces=800)
        made.write(self.folder / "made.off")
        self.assertEqual((self.folder / "made.off").read_bytes(), (self.folder / "synth/cup_003.off").read_bytes())
        self.assertEqual(made.name, "cup_003")
        [read] = exemplar.read_labeled(self.folder / "synth")
        np.testing.assert_array_equal(np.array(read.label_names)[read.labels], np.array(made.label_names)[made.labels])

    def test_refuses_what_there_is_not(self):
        self.assertIn("fourleg", exemplar.shape_kinds())
        self.raises(exemplar.UsageError, "foreleg", exemplar.make_shape, "foreleg")
        self.raises(exemplar.UsageError, "faces: 3 is no whole number", exemplar.make_shape, "cup", faces=3)


if __name__ == "__main__":
    unittest.main()

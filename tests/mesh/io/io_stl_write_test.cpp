#include <gtest/gtest.h>

#include <limits>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

TEST(WriteStl, ComesBack) {
    const TemporaryFolder folder;
    TriangleMesh mesh = shapes::icosphere(2, 3);
    write_stl(folder / "ball.stl", mesh);
    const MeshFile read = read_mesh(folder / "ball.stl");
    ASSERT_EQ(read.mesh.face_count(), mesh.face_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner)
            EXPECT_EQ(read.mesh.vertices[read.mesh.faces[f][corner]], mesh.vertices[mesh.faces[f][corner]]);
    mesh.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(write_stl(folder / "nan.stl", mesh), MeshError);
}

}  // namespace
}  // namespace exemplar

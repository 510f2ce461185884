// Reads the mesh that it is given, tells what is wrong with it, and along which axes it extends.

#include <cstdio>

#include "host/core/errors.h"
#include "host/learn/components/pca.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    try {
        const exemplar::TriangleMesh mesh = exemplar::read_mesh(argv[1]).mesh;
        const exemplar::MeshReport report = exemplar::require_usable(mesh, argv[1]);
        for (const std::string& message : report.messages()) std::printf("%s\n", message.c_str());
        Eigen::MatrixXf points(mesh.vertex_count(), 3);
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v) points.row(Eigen::Index(v)) = mesh.vertices[v];
        // What it holds was allocated in the library and is freed here.
        const exemplar::Pca axes = exemplar::fit_pca(points, 1);
        std::printf("%zu faces, %zu boundary edges, variances", mesh.face_count(), report.boundary_edges);
        for (const double variance : axes.variance) std::printf(" %.3f", variance);
        std::printf("\n");
    } catch (const exemplar::Error& error) {
        std::printf("refused: %s\n", error.what());
        return 1;
    }
    return 0;
}

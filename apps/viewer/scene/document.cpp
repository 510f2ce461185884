#include "apps/viewer/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "host/animation/read_surface.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/mesh/io/io.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

void color_by(Document& document, const FaceLabels& labels) {
    document.legend.clear();
    for (std::size_t i = 0; i < labels.names.size(); ++i) document.legend.push_back({labels.names[i], label_color(i)});
    document.face_colors.clear();
    const TriangleMesh& surface = document.animation.rest;
    for (std::uint32_t f = 0; f < surface.face_count(); ++f) {
        const std::int32_t label = labels.label.at(surface.source_of(f));
        document.face_colors.push_back(label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label)));
    }
}

// Adds labels found beside the mesh. Errors in them become warnings, as the mesh can be shown without labels.
void add_labels_beside(Document& document) {
    const fs::path segments = fs::path(document.path).replace_extension(".seg");
    for (const fs::path& candidate : {labels_path(document.path), segments}) {
        if (!fs::exists(candidate)) continue;
        try {
            add_labels(document, candidate);
        } catch (const Error& error) {
            document.animation.warnings.emplace_back(error.what());
            continue;
        }
        return;
    }
}

}  // namespace

Document read_document(const fs::path& path) {
    SurfaceFile file = read_surface(path);
    Document document;
    document.path = path;
    document.animation = std::move(file.animation);
    if (document.animation.moves()) return document;
    document.animation.name = path.filename().string();
    if (file.labels)
        color_by(document, *file.labels);
    else
        add_labels_beside(document);
    return document;
}

void add_labels(Document& document, const fs::path& path) {
    color_by(document, read_face_labels(path, document.animation.rest));
}

}  // namespace exemplar

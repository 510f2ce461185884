#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/labeling/painting/painted_labels.h"
#include "host/mesh/io/io.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// A shape of a folder that a person labels.
struct FolderShape {
    std::filesystem::path path;
    bool verified = false;  ///< it has NAME_labels.txt
    bool begun = false;     ///< it has strokes that are not verified: NAME_painting.json
};

/// A folder whose shapes a person labels. Everything is in files beside the shapes, each replaced as a whole, so that a
/// crash or a second window loses nothing: labels of verified shapes in NAME_labels.txt, strokes on others in
/// NAME_painting.json, names and colors of labels in palette.json.
class LabelingFolder {
  public:
    /// Lists the meshes of a folder, or a single mesh. The palette is that of palette.json, then labels that only
    /// verified shapes have. Damaged files of either become warnings. Throws DataError if there is no mesh.
    explicit LabelingFolder(const std::filesystem::path& source);

    const std::vector<FolderShape>& shapes() const { return shapes_; }
    std::size_t verified_count() const;
    const std::vector<PaletteEntry>& palette() const { return palette_; }
    const std::vector<std::string>& warnings() const { return warnings_; }

    /// Sets the palette and writes it to palette.json. Throws DataError if it cannot be written, UsageError for names
    /// that are equal or impossible (see checked_label_name).
    void set_palette(std::vector<PaletteEntry> palette);

    /// Returns the labels of a verified shape, indices into the palette, of so many faces. Throws as read_face_labels.
    std::vector<std::int32_t> read_labels(std::size_t shape, std::size_t faces);
    /// Returns labels of other forms on a shape that is not verified (see labels_of_mesh): in a PLY, groups of an OBJ,
    /// NAME.vtp and so on; nullopt if there are none. Throws DataError if they are damaged.
    std::optional<std::vector<std::int32_t>> read_other_labels(std::size_t shape, const MeshFile& file);
    /// Returns the strokes on a shape that are not verified; nullopt if there are none. Throws as load_painting.
    std::optional<std::vector<std::int32_t>> read_strokes(std::size_t shape, std::size_t faces);

    /// Keeps the strokes on a shape, for the case of a crash. Throws DataError if they cannot be written.
    void save_strokes(std::size_t shape, std::vector<std::int32_t> label);
    /// Writes the labels of a verified shape and removes its strokes. If the file was changed since it was last read or
    /// written here, by another window or program, throws DataError the first time and replaces it the second time.
    /// Throws DataError if it cannot be written, or a face has no label.
    void save_labels(std::size_t shape, std::vector<std::int32_t> label);

  private:
    std::filesystem::path labels_file(std::size_t shape) const;
    std::vector<std::int32_t> in_palette(const FaceLabels& labels);
    void note_version(std::size_t shape);

    std::filesystem::path folder_;
    std::vector<FolderShape> shapes_;
    std::vector<PaletteEntry> palette_;
    std::vector<std::string> warnings_;
    /// Per shape the time of its labels file, as it was when it was last read or written; empty if there was none.
    std::vector<std::optional<std::filesystem::file_time_type>> seen_;
};

}  // namespace exemplar

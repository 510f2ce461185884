#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/imaging/image.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// A picture of a figure.
struct FigurePanel {
    std::string name;     ///< of its file, without ".png"
    std::string caption;  ///< a line of text below it
    Image image;          ///< gray or RGB
};

/// An entry of a legend: a color, and what it stands for.
struct FigureKey {
    Color color;
    std::string text;
};

/// A figure: rows of panels below a title, then a legend.
struct Figure {
    std::string title;
    std::vector<std::vector<FigurePanel>> rows;
    std::vector<FigureKey> legend;
};

/// Writes each panel as NAME.png into a folder, and figures.svg, which holds all of them, so that it can be moved
/// alone. Panels of a row are as wide as each other. Creates the folder; throws DataError if it cannot be written.
void write_figures(const std::filesystem::path& folder, std::span<const Figure> figures);

}  // namespace exemplar

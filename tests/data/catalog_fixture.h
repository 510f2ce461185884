#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"
#include "host/data/catalog/catalog_run.h"
#include "tests/support/mesh_files.h"

namespace exemplar {

inline CatalogShape shape_at(const std::string& path, const std::string& hash = "0123") {
    CatalogShape shape;
    shape.path = path;
    shape.name = output_name(std::filesystem::path(path).relative_path());
    shape.bytes = 100;
    shape.modified = 7;
    shape.hash = hash;
    shape.vertices = 8;
    shape.faces = 12;
    shape.components = 1;
    return shape;
}

inline ShapeRecord record_for(const CatalogShape& shape, const CatalogRun& run, const std::string& error = {}) {
    ShapeRecord record;
    record.run = run.key();
    record.content = content_of(shape);
    record.worker = "somebody";
    record.error = error;
    record.model = "cup";
    record.confidence = 0.75;
    record.labels = {{{"label", "handle"}, {"area_share", 0.25}}};
    record.seconds = {{"read", 0.5}, {"cut", 0.25}};
    record.finished = 1e9;
    return record;
}

class CatalogTest : public testing::Test {
  protected:
    std::vector<CatalogShape> all() {
        std::vector<CatalogShape> shapes;
        catalog_.for_each([&](const CatalogShape& shape) { shapes.push_back(shape); });
        return shapes;
    }
    std::vector<std::string> names() {
        std::vector<std::string> names;
        for (const CatalogShape& shape : all()) names.push_back(shape.name);
        return names;
    }
    void put(const std::vector<CatalogShape>& shapes) { catalog_.put(shapes); }
    TemporaryFolder folder_;
    Catalog catalog_{folder_ / "shapes.db", Database::Open::create};
};

}  // namespace exemplar

#include "host/labeling/batch/batch_labeling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>
#include <new>

#include "host/core/device_memory_error.h"
#include "host/core/errors.h"
#include "host/data/catalog/shape_scan.h"
#include "host/labeling/training/training.h"
#include "host/mesh/io/io.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::error_of;
using testing::HasSubstr;

/// A scorer that is told when to fail, and counts the meshes of its calls.
class WatchedScorer final : public StumpScorer {
  public:
    void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                              std::span<const ScoredMatrix> matrices) override {
        most_at_once = std::max(most_at_once, matrices.size());
        if (before) before(matrices.size());
        scorer_.probabilities_of_all(classifier, link, scale, matrices);
    }
    std::function<void(std::size_t)> before;
    std::size_t most_at_once = 0;

  private:
    CpuStumpScorer scorer_;
};

/// A sphere whose upper half is label 1, the rest 0.
LabeledMesh halves(float height) {
    LabeledMesh sphere{"sphere", {}, shapes::icosphere(2, 1.0F), {}};  // 320 faces
    for (Vec3& v : sphere.mesh.vertices)
        if (v.z() > 0) v.z() *= height;
    for (const Vec3& center : face_centers(sphere.mesh)) sphere.label.push_back(center.z() > 0 ? 1 : 0);
    return sphere;
}

LabelingModel trained() {
    const LabeledCorpus corpus{{"low", "high"}, {halves(2.0F), halves(2.2F), halves(2.4F)}, {}};
    TrainOptions options;
    options.rounds = 10, options.max_stages = 1, options.rows_per_mesh = 200, options.features.samples = 60;
    std::vector<MeshFeatures> features;
    for (const LabeledMesh& mesh : corpus.meshes) features.push_back(compute_features(mesh.mesh, options.features));
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    TrainReport report;
    return train_labeling(corpus, features, options, {scorer, context}, report);
}

class BatchLabeling : public testing::Test {
  protected:
    BatchLabeling() {
        static const LabelingModel model = trained();
        models_.models.push_back({"sphere", "hash", model});
        models_.features = model.feature_options;
        models_.is_single_model = true;
    }
    /// A shape in a file, as a catalog knows it.
    void add(const TriangleMesh& mesh, const std::string& category = {}) {
        const auto path = folder_ / (std::to_string(shapes_.size()) + ".off");
        write_off(path, mesh);
        add_file(path, category);
    }
    void add_file(const std::filesystem::path& path, const std::string& category = {}) {
        CatalogShape shape = describe_shape(path, std::size_t{1} << 30);
        shape.name = path.stem().string();
        shape.category = category;
        shapes_.push_back(std::move(shape));
    }
    std::vector<StageStatistics> run() {
        std::size_t next = 0;
        const auto give = [&]() -> std::optional<CatalogShape> {
            if (next == shapes_.size()) return {};
            return shapes_[next++];
        };
        const auto keep = [&](BatchShape& shape) {
            records_[shape.shape.name] = shape.record;
            labels_[shape.shape.name] = shape.labeling.label;
            changed_ += shape.changed ? 1 : 0;
            if (written_) written_();
        };
        return label_batch(give, keep, models_, {scorer_, context_}, options_);
    }
    std::string error(const std::string& name) { return records_.at(name).error; }

    TemporaryFolder folder_;
    BatchModels models_;
    WatchedScorer scorer_;
    CpuContextHistograms context_;
    BatchOptions options_{.cache = {}, .memory = std::size_t{1} << 30, .group = 4};
    std::vector<CatalogShape> shapes_;
    std::map<std::string, ShapeRecord> records_;
    std::map<std::string, std::vector<std::int32_t>> labels_;
    std::size_t changed_ = 0;
    std::function<void()> written_;
};

TEST_F(BatchLabeling, LabelsAsOneByOne) {
    for (int i = 0; i < 9; ++i) add(halves(2.0F + 0.1F * static_cast<float>(i)).mesh);
    const std::vector<StageStatistics> stages = run();
    ASSERT_EQ(records_.size(), 9u);
    for (const CatalogShape& shape : shapes_) {
        const TriangleMesh mesh = read_mesh(shape.path).mesh;
        CpuStumpScorer scorer;
        EXPECT_EQ(labels_[shape.name], label_mesh(models_.models.front().model, mesh, {}, {scorer, context_}).label);
        EXPECT_EQ(records_[shape.name].content, shape.hash);
        EXPECT_EQ(records_[shape.name].model, "sphere");
    }
    for (const StageStatistics& stage : stages) EXPECT_EQ(stage.items, 9u) << stage.name;
    EXPECT_LE(scorer_.most_at_once, options_.group);
}

TEST_F(BatchLabeling, ALostDeviceEndsTheWork) {
    for (int i = 0; i < 12; ++i) add(halves(2.0F).mesh);
    int calls = 0;
    scorer_.before = [&](std::size_t) {
        if (++calls == 8) throw DeviceError("the device was lost");
    };
    EXPECT_THAT(error_of<DeviceError>([&] { run(); }), HasSubstr("was lost"));
    EXPECT_LT(records_.size(), 12u);
    for (const auto& [name, record] : records_) EXPECT_EQ(record.error, "") << name;  // no shape is to blame
}

TEST_F(BatchLabeling, WhatCannotBeWrittenEndsTheWork) {
    for (int i = 0; i < 12; ++i) add(halves(2.0F).mesh);
    written_ = [&] {
        if (records_.size() == 3) throw DataError("the disk is full");
    };
    EXPECT_THAT(error_of<DataError>([&] { run(); }), HasSubstr("is full"));
    EXPECT_EQ(records_.size(), 3u);
}

TEST_F(BatchLabeling, FewerAtOnceWhereThereIsNoMemoryForAll) {
    for (int i = 0; i < 6; ++i) add(halves(2.0F + 0.1F * static_cast<float>(i)).mesh);
    scorer_.before = [](std::size_t meshes) {
        if (meshes > 1) throw DeviceMemoryError("the device's memory is used up");
    };
    run();
    ASSERT_EQ(records_.size(), 6u);
    for (const auto& [name, record] : records_) EXPECT_EQ(record.error, "") << name;
}

TEST_F(BatchLabeling, AShapeThatIsTooLargeAloneIsItsOwnError) {
    for (int i = 0; i < 3; ++i) add(halves(2.0F).mesh);
    scorer_.before = [](std::size_t) { throw std::bad_alloc(); };
    run();
    ASSERT_EQ(records_.size(), 3u);
    for (const auto& [name, record] : records_) EXPECT_THAT(record.error, HasSubstr("not enough memory")) << name;
}

TEST_F(BatchLabeling, BadShapesAreTheirOwnErrors) {
    add(halves(2.0F).mesh);
    mesh_files::write_bytes(folder_ / "cut.off", "OFF\n8 12 0\n0 0 0\n");
    add_file(folder_ / "cut.off");
    add(halves(2.2F).mesh);
    add(halves(2.4F).mesh);
    std::filesystem::remove(shapes_[2].path);
    run();
    EXPECT_EQ(error("0"), "");
    EXPECT_THAT(error("cut"), HasSubstr("cut.off:"));
    EXPECT_THAT(error("2"), HasSubstr("cannot be read"));
    EXPECT_EQ(error("3"), "");
}

TEST_F(BatchLabeling, AShapeLargerThanTheBudgetIsLabeledAlone) {
    for (int i = 0; i < 5; ++i) add(halves(2.0F).mesh);
    options_.memory = 1 << 20;  // one wants 4 MB at least
    run();
    ASSERT_EQ(records_.size(), 5u);
    for (const auto& [name, record] : records_) EXPECT_EQ(record.error, "") << name;
}

TEST_F(BatchLabeling, AFileTooLargeForThisProgramStaysWhatItIs) {
    add(halves(2.0F).mesh);
    add(halves(2.0F).mesh);
    std::string large = read_file(shapes_[1].path);
    large += "# " + std::string(1 << 20, 'x') + "\n";
    mesh_files::write_bytes(shapes_[1].path, large);
    shapes_.pop_back();
    add_file(folder_ / "1.off");
    options_.memory = 1 << 20;  // too little to read a megabyte
    run();
    EXPECT_EQ(error("0"), "");
    EXPECT_THAT(error("1"), HasSubstr("more than can be read"));
    EXPECT_EQ(records_["1"].content, shapes_[1].hash) << "another program may have the memory";
    EXPECT_EQ(changed_, 0U);
}

TEST_F(BatchLabeling, WhatAFileNamesCountsWithIt) {
    const std::string buffer = R"({"uri": "beside.bin", "byteLength": 2000000000})";
    mesh_files::write_bytes(folder_ / "a.gltf", R"({"asset": {"version": "2.0"}, "buffers": []})");
    add_file(folder_ / "a.gltf");
    mesh_files::write_bytes(folder_ / "a.gltf", R"({"asset": {"version": "2.0"}, "buffers": [)" + buffer + "]}");
    shapes_.front().problem.clear();
    run();
    EXPECT_THAT(error("a"), HasSubstr("more than can be read"));
}

TEST_F(BatchLabeling, TheGivenCategoryChoosesTheModel) {
    models_.is_single_model = false;
    models_.models.push_back(models_.models.front());
    models_.models.back().name = "Ball";
    add(halves(2.0F).mesh, "sphere");
    add(halves(2.0F).mesh, "ball");
    add(halves(2.0F).mesh, "cube");
    add(halves(2.0F).mesh);
    run();
    EXPECT_EQ(records_["0"].model, "sphere");
    EXPECT_EQ(records_["1"].model, "Ball");
    EXPECT_THAT(error("2"), HasSubstr("no model of the category 'cube'"));
    EXPECT_THAT(error("3"), HasSubstr("its category is not known"));
    models_.is_single_model = true;
    run();
    for (const auto& [name, record] : records_) EXPECT_EQ(record.model, "sphere") << name;
}

}  // namespace
}  // namespace exemplar

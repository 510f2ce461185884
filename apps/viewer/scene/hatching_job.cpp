#include "apps/viewer/scene/hatching_job.h"

#include <utility>

#include "host/core/cancel.h"
#include "host/core/interrupt.h"

namespace exemplar {

HatchingJob::HatchingJob(HatchedStill still, StillNames names) {
    start([this, still = std::move(still), names = std::move(names)] { return run(still, names); });
}

std::vector<std::filesystem::path> HatchingJob::run(const HatchedStill& still, const StillNames& names) {
    const auto step = [this](const char* what) {
        check_interrupt();
        what_ = what;
    };
    HatchedDrawing drawing;
    run_cancelable(canceled_flag(), [&] {
        drawing = draw_still(still, step);
        step("saving");
    });
    // Can no longer be canceled, so that all files are written or none.
    std::vector<std::filesystem::path> files = names();
    for (const std::filesystem::path& file : files) write_still(file, still, drawing);
    return files;
}

}  // namespace exemplar

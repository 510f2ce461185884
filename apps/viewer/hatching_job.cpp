#include "apps/viewer/hatching_job.h"

#include <utility>

#include "host/core/cancel.h"
#include "host/core/interrupt.h"

namespace exemplar {

HatchingJob::HatchingJob(HatchedStill still, std::vector<std::filesystem::path> files) {
    start([this, still = std::move(still), files = std::move(files)] {
        run(still, files);
        return files;
    });
}

void HatchingJob::run(const HatchedStill& still, const std::vector<std::filesystem::path>& files) {
    const auto step = [this](const char* what) {
        check_interrupt();
        what_ = what;
    };
    run_cancelable(canceled_flag(), [&] {
        const HatchedDrawing drawing = draw_still(still, step);
        step("saving");
        for (const std::filesystem::path& file : files) write_still(file, still, drawing);
    });
}

}  // namespace exemplar

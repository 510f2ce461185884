#pragma once

#include "apps/exemplar/common_options.h"
#include "apps/help/command.h"

namespace exemplar {

// One function per file of the same name: adds the subcommand, whose callback does the work and throws Error.
void add_devices_command(Command& app);
void add_doctor_command(Command& app);
void add_features_command(Command& app);
void add_synth_command(Command& app);
void add_label_command(Command& app);
void add_train_command(Command& label);
void add_apply_command(Command& label);
void add_batch_command(Command& label);
void add_evaluate_command(Command& label);
void add_study_command(Command& label);
void add_stress_command(Command& label);
void add_next_command(Command& label);
void add_simulate_command(Command& label);
void add_split_command(Command& label);
void add_transfer_command(Command& label);
void add_rig_command(Command& label);
void add_materials_command(Command& label);
void add_prototype_command(Command& label);
void add_glasses_command(Command& prototype);
void add_category_command(Command& app);
void add_category_train_command(Command& category);
void add_category_apply_command(Command& category);
void add_category_evaluate_command(Command& category);
void add_curvature_command(Command& app);
void add_curvature_train_command(Command& curvature);
void add_curvature_evaluate_command(Command& curvature);
void add_curvature_study_command(Command& curvature);
void add_lines_command(Command& app);
void add_hatch_command(Command& app);
void add_hatch_template_command(Command& hatch);
void add_hatch_example_command(Command& hatch);
void add_hatch_register_command(Command& hatch);
void add_hatch_extract_command(Command& hatch);
void add_hatch_train_command(Command& hatch);
void add_hatch_draw_command(Command& hatch);
void add_hatch_compare_command(Command& hatch);
void add_hatch_figures_command(Command& hatch);
void add_hatch_features_command(Command& hatch);
void add_hatch_evaluate_command(Command& hatch);
void add_catalog_command(Command& app);
void add_catalog_add_command(Command& catalog);
void add_catalog_list_command(Command& catalog);
void add_catalog_status_command(Command& catalog);
void add_catalog_export_command(Command& catalog);
void add_catalog_merge_command(Command& catalog);
void add_demo_command(Command& app);
void add_bench_command(Command& app);
void add_bench_shaders_command(Command& bench);
void add_bench_spirv_command(Command& bench);
void add_bench_outlines_command(Command& bench);

}  // namespace exemplar

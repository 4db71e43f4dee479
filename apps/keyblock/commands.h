#pragma once

namespace CLI {
class App;
}

/// The commands. Each function adds one to the command line; its work is done while the command line is parsed and
/// throws what the work throws (see command_line.h).
namespace keyblock::app {

void add_run(CLI::App& app);
/// Mistakes that are printed as JSON set `exit_code`, which must outlive the parsing.
void add_check(CLI::App& app, int& exit_code);
void add_cut(CLI::App& app);
void add_report(CLI::App& app);
void add_export(CLI::App& app);
void add_picture(CLI::App& app);
void add_film(CLI::App& app);
void add_motion(CLI::App& app, int& exit_code);
/// A row that does not hold sets `exit_code`, which must outlive the parsing.
void add_verify(CLI::App& app, int& exit_code);

void add_limit(CLI::App& app);
void add_safety(CLI::App& app);
void add_bolt(CLI::App& app);
/// Around the work: new, schema, completion, manual-page.
void add_new(CLI::App& app);
void add_schema(CLI::App& app);
void add_completion(CLI::App& app);
void add_manual(CLI::App& app);

/// study run, study task, study collect, study submit.
void add_study(CLI::App& app);
void add_risk(CLI::App& app);

}  // namespace keyblock::app

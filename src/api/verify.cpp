#include "keyblock/verify.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <utility>

#include "keyblock/keyblock.h"
#include "scenario/key_path.h"
#include "verification/report.h"
#include "verification/verify.h"

namespace keyblock {
namespace {

void check_names(const std::vector<verification::CaseFile>& cases, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const verification::CaseFile& file : cases) known.push_back(file.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    Diagnostic diagnostic;
    diagnostic.key = "names";
    diagnostic.found = "no case '" + name + "'";
    diagnostic.expected = "one of " + scenario::list_words(known);
    diagnostic.hint = scenario::suggestion(name, known);
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace

std::string verify(const VerifyRequest& request) {
  std::vector<verification::CaseFile> cases = verification::read_cases(request.cases);
  check_names(cases, request.names);
  if (!request.names.empty()) {
    std::erase_if(cases, [&](const verification::CaseFile& file) {
      return std::find(request.names.begin(), request.names.end(), file.name) == request.names.end();
    });
  }
  std::atomic<bool> stop = false;
  verification::VerifyOptions options;
  options.all = request.all || !request.names.empty();
  options.orders = std::set<int>(request.orders.begin(), request.orders.end());
  options.workers = request.workers;
  options.version = version();
  options.stop = &stop;
  const auto results = verification::verify(
      cases, options,
      [&](std::size_t done, std::size_t count, const verification::CaseFile&, const verification::RunSpec&) {
        if (request.progress && !request.progress(done, count)) stop = true;
      });
  return verification::table_json(results, version());
}

}  // namespace keyblock

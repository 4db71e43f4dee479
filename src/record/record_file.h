#pragma once

namespace keyblock::record {

/// How far a field of a record goes: each of these has the fields of the ones before it.
enum class RecordFile : unsigned char {
  summary,  ///< summary.json
  page,     ///< the report
  result,   ///< result.h5, and checkpoints
};

}  // namespace keyblock::record

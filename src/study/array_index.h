#pragma once
#include <cstddef>
#include <string>

namespace keyblock::study {

/// Which run a task of a job array is to do: `given`, or where that is empty the first of these environment variables that
/// holds a number: SLURM_ARRAY_TASK_ID, SGE_TASK_ID, PBS_ARRAY_INDEX, PBS_ARRAYID, LSB_JOBINDEX, JOB_COMPLETION_INDEX
/// (Kubernetes); less `first`. Throws InputError when there is none, or it is not a place among `count` runs.
std::size_t array_index(const std::string& given, long first, std::size_t count);

}  // namespace keyblock::study

#pragma once

#include <fstream>

#include "scenarios/output_folder.h"
#include "scenarios/picture_record.h"

namespace nightjar::scenarios {

/// Writes estimates.csv: truth beside estimate, one row a picture, units in the
/// header; columns of an estimate that is not valid are empty.
class EstimatesCsv {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  explicit EstimatesCsv(OutputFolder& folder);

  void add(const PictureRecord& record);

  /// Completes the file. Throws std::runtime_error when not everything reached
  /// the disk.
  void finish();

 private:
  OutputFolder& folder_;
  std::ofstream out_;
};

}  // namespace nightjar::scenarios

#pragma once

namespace nightjar::scenarios {

/// The tag printed on the scene's board: the truth that detections are scored by,
/// whatever the tracker takes it for (tracker.detector).
struct TagConfig {
  int id = 0;            ///< Of family 36h11.
  double size_m = 0.24;  ///< Side of the black square, without the white border.

  template <class Visitor>
  void visit(Visitor& v) {
    v.field("id", id, 0, 586);
    v.field("size_m", size_m, 0.01, 10.0);
  }
};

}  // namespace nightjar::scenarios

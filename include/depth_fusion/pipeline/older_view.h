// The map as it was seen some time ago. A map that moves along with wrong poses fits them all the while; in
// this view what they have made of it does not show.
#pragma once

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/frames/model_view.h"

namespace depth_fusion {

class OlderView {
 public:
  explicit OlderView(ComputeContext& compute) : compute_(compute) {}

  // Keeps a copy of the view.
  void keep(const ModelView& view);
  void forget() { is_kept_ = false; }
  // Null where none is kept.
  const ModelView* view() const { return is_kept_ ? &view_ : nullptr; }

 private:
  ComputeContext& compute_;
  ModelView view_;
  bool is_kept_ = false;
};

}  // namespace depth_fusion

// Places of a run at given times.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rolling/slope/runs/run.hpp"

namespace rolling_ellipse {

// Reads places at times after `from`. Integrals over the current half turn are kept for the next
// times in it; the bits of an answer do not depend on earlier calls.
class RunReader {
  public:
    explicit RunReader(const SlopeRun& run);
    SlopePlace operator()(DoubleDouble time);

  private:
    using PartArray = std::array<double, part_order>;

    void move_to(DoubleDouble since);
    void set_half_turn(double half_turns);
    double node_time(const RunNodes& nodes, std::size_t i) const;
    PartArray node_times(std::size_t part) const;
    double part_time(std::size_t part);
    SlopePlace place_at(double rest);

    const SlopeRun& run_;
    double half_turns_ = 0.0;  // number before the current half turn
    DoubleDouble begin_;       // time of the current half turn since `from`
    double lasts_ = 0.0;       // its duration; 0 before the first call
    std::vector<double> panel_times_;
    std::vector<double> part_times_;  // negative where not computed yet
    std::size_t part_ = 0;            // the part whose Legendre coefficients are kept
    PartArray coefficients_{};
};

}  // namespace rolling_ellipse

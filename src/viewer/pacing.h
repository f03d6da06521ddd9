// Real time in, whole simulation frames out. What cannot be computed in time is dropped and said, so that
// a slow machine shows slow motion with the same physics.
#pragma once
#include <cstddef>
#include <deque>

namespace weft {

class Pacer {
 public:
  /// @param frame_s simulated length of one frame
  explicit Pacer(double frame_s);
  void set_frame(double frame_s);
  void set_speed(double speed);  ///< simulated seconds wanted for one of wall time, 1 = real time
  double frame_s() const { return frame_s_; }
  double speed() const { return speed_; }

  /// Wall time passed since the last call. At most kLongest_s of it counts: a pause is not caught up.
  void elapse(double wall_s);
  /// Whether another frame is owed.
  bool frame_due() const { return debt_s_ >= frame_s_ * (1.0 - 1e-9); }
  /// How many, in parts of one too.
  double frames_owed() const { return debt_s_ / frame_s_; }
  void frame_done();
  /// So much of the frame under way is computed: it counts for the speed at once, not in one leap at the end.
  void frame_reached(double simulated_s);
  /// What was computed of a frame that is given up stays counted; the next one begins at nothing.
  void begin_frame() { reached_s_ = 0.0; }
  /// Time for this picture is spent: whatever is owed beyond so many frames will never be computed.
  void give_up_rest(double frames = 1.0);
  /// Forgets debt and history, after a pause or a change of scene.
  void restart();

  /// Simulated over wall time in the last second or so; 0 before anything ran.
  double real_time_factor() const;
  /// Whether less than 97 % of the wanted speed was reached in that time.
  bool slow_motion() const;

  static constexpr double kLongest_s = 0.25;

 private:
  struct Moment {
    double wall_s, simulated_s;
  };
  double frame_s_, speed_ = 1.0, debt_s_ = 0.0;
  double wall_s_ = 0.0, simulated_s_ = 0.0;
  double reached_s_ = 0.0;  // of the frame under way, counted already
  std::deque<Moment> history_;
};

}  // namespace weft

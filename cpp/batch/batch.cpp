#include "batch_implementation.hpp"

namespace quadcore {

Batch::Batch(std::vector<BatchVehicle> vehicles, const World& world,
             const SimulationOptions& options, unsigned threads)
    : implementation_(
          std::make_unique<Implementation>(std::move(vehicles), world, options, threads)) {}
Batch::~Batch() = default;
Batch::Batch(Batch&&) noexcept = default;

void Batch::follow_together(const CommandAll& command_all, double rate, double delay,
                            const std::string& odometry, std::int64_t steps, std::int64_t log_every,
                            std::vector<BatchGuided>& guided) {
  implementation_->follow_together(command_all, rate, delay, odometry, steps, log_every, guided);
}

std::size_t Batch::size() const { return implementation_->size(); }
std::size_t Batch::command_width() const { return implementation_->command_width(); }
std::size_t Batch::state_width() const { return implementation_->state_width(); }
std::size_t Batch::log_width() const { return implementation_->log_width(); }
double Batch::dt() const { return implementation_->dt(); }
void Batch::follow(const std::vector<BatchGuide>& guides, const std::string& odometry,
                   std::int64_t steps, std::int64_t log_every, std::vector<BatchGuided>& guided,
                   const std::function<void()>& poll) {
  implementation_->follow(guides, odometry, steps, log_every, guided, poll);
}
void Batch::step(const double* commands, std::int64_t count) {
  implementation_->step(commands, count);
}
void Batch::get_state(double* rows) const { implementation_->get_state(rows); }
void Batch::set_state(const double* rows) { implementation_->set_state(rows); }
double Batch::time(std::size_t vehicle) const { return implementation_->time(vehicle); }
const std::vector<std::string>& Batch::failures() const { return implementation_->failures(); }
const std::vector<std::string>& Batch::warnings(std::size_t vehicle) const {
  return implementation_->warnings(vehicle);
}
void Batch::reset(const bool* mask, const std::uint64_t* seeds) {
  implementation_->reset(mask, seeds);
}
BatchSnapshot Batch::snapshot() const { return implementation_->snapshot(); }
void Batch::restore(const BatchSnapshot& snapshot) { implementation_->restore(snapshot); }

}  // namespace quadcore

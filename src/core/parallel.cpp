#include "core/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace keyblock {

struct ThreadTeam::Shared {
  std::mutex mutex;
  std::condition_variable wake, done;
  std::vector<std::thread> workers;
  const std::function<void(std::size_t, std::size_t)>* body = nullptr;
  std::size_t n = 0;
  unsigned long generation = 0;
  int running = 0;
  bool quit = false;
  std::vector<std::exception_ptr> errors;

  void piece(int rank, int size) {
    const auto at = [&](int r) { return n * static_cast<std::size_t>(r) / static_cast<std::size_t>(size); };
    try {
      (*body)(at(rank), at(rank + 1));
    } catch (...) {
      errors[static_cast<std::size_t>(rank)] = std::current_exception();
    }
  }

  void work(int rank, int size) {
    unsigned long seen = 0;
    for (;;) {
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return quit || generation != seen; });
        if (quit) return;
        seen = generation;
      }
      piece(rank, size);
      std::lock_guard lock(mutex);
      if (--running == 0) done.notify_one();
    }
  }
};

ThreadTeam::ThreadTeam(int threads) : size_(std::max(1, threads)) {
  if (size_ == 1) return;
  shared_ = std::make_unique<Shared>();
  shared_->errors.resize(static_cast<std::size_t>(size_));
  for (int rank = 1; rank < size_; ++rank) {
    shared_->workers.emplace_back([this, rank] { shared_->work(rank, size_); });
  }
}

ThreadTeam::~ThreadTeam() {
  if (!shared_) return;
  {
    std::lock_guard lock(shared_->mutex);
    shared_->quit = true;
  }
  shared_->wake.notify_all();
  for (std::thread& worker : shared_->workers) worker.join();
}

void ThreadTeam::for_range(std::size_t n, std::size_t grain,
                           const std::function<void(std::size_t, std::size_t)>& body) {
  if (size_ == 1 || n < grain) {
    if (n > 0) body(0, n);
    return;
  }
  {
    std::lock_guard lock(shared_->mutex);
    shared_->body = &body;
    shared_->n = n;
    shared_->running = size_ - 1;
    ++shared_->generation;
  }
  shared_->wake.notify_all();
  shared_->piece(0, size_);
  std::unique_lock lock(shared_->mutex);
  shared_->done.wait(lock, [&] { return shared_->running == 0; });
  for (std::exception_ptr& error : shared_->errors) {
    if (error) std::rethrow_exception(std::exchange(error, nullptr));
  }
}

}  // namespace keyblock

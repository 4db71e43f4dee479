#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"

namespace keyblock {

namespace {

/// Waits for a while for what is about to happen: the loops of a step follow each other within microseconds, and to wake a
/// thread takes longer than many of them. False when it did not. looks: 0, not at all.
template <typename Condition>
bool happens_soon(int looks, const Condition& condition) {
  for (int k = 0; k < looks; ++k) {
    if (condition()) return true;
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  return false;
}

}  // namespace

struct ThreadTeam::Shared {
  std::mutex mutex;  // of those that sleep
  std::condition_variable wake, done;
  std::vector<std::thread> workers;
  const std::function<void(std::size_t, std::size_t)>* body = nullptr;
  std::size_t n = 0;
  std::atomic<unsigned long> generation = 0;  // of loops; body and n are there before it is raised
  std::atomic<int> running = 0;
  std::atomic<bool> quit = false;
  std::vector<std::exception_ptr> errors;
  int looks = 0;  // before a thread sleeps

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
    const auto is_called = [&] { return quit || generation != seen; };
    for (;;) {
      if (!happens_soon(looks, is_called)) {
        std::unique_lock lock(mutex);
        wake.wait(lock, is_called);
      }
      if (quit) return;
      seen = generation;
      piece(rank, size);
      if (--running > 0) continue;
      std::lock_guard lock(mutex);
      done.notify_one();
    }
  }

  void dismiss() {
    {
      std::lock_guard lock(mutex);
      quit = true;
    }
    wake.notify_all();
    for (std::thread& worker : workers) worker.join();
    workers.clear();
  }
};

int processors() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadTeam::ThreadTeam(int threads) : size_(std::max(1, threads)) {
  if (size_ == 1) return;
  shared_ = std::make_unique<Shared>();
  shared_->errors.resize(static_cast<std::size_t>(size_));
  // Some 50 µs; where threads share a processor, one that waits awake keeps it from those that are waited for.
  if (size_ <= processors()) shared_->looks = 2'000;
  try {
    for (int rank = 1; rank < size_; ++rank) {
      shared_->workers.emplace_back([this, rank] { shared_->work(rank, size_); });
    }
  } catch (const std::exception& e) {  // the system has no more threads, or no memory for one
    const std::size_t started = shared_->workers.size() + 1;
    shared_->dismiss();  // a thread that is not joined ends the program
    throw RunError("of the " + std::to_string(size_) + " threads asked for, only " + std::to_string(started) +
                   " could be started: " + e.what());
  }
}

ThreadTeam::~ThreadTeam() {
  if (shared_) shared_->dismiss();
}

void ThreadTeam::for_range(std::size_t n, std::size_t grain,
                           const std::function<void(std::size_t, std::size_t)>& body) {
  if (size_ == 1 || n < grain) {
    if (n > 0) body(0, n);
    return;
  }
  shared_->body = &body;
  shared_->n = n;
  shared_->running = size_ - 1;
  {
    std::lock_guard lock(shared_->mutex);
    ++shared_->generation;
  }
  shared_->wake.notify_all();
  shared_->piece(0, size_);
  const auto is_done = [&] { return shared_->running == 0; };
  if (!happens_soon(shared_->looks, is_done)) {
    std::unique_lock lock(shared_->mutex);
    shared_->done.wait(lock, is_done);
  }
  // All are taken off: one that stayed would be thrown by the next loop.
  std::exception_ptr first;
  for (std::exception_ptr& error : shared_->errors) {
    if (!first) first = error;
    error = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

}  // namespace keyblock

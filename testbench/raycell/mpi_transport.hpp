// Ranks as processes that mpirun started. This interface shows nothing of MPI; without MPI the program is
// built with mpi_missing.cpp instead.
#pragma once

#include <memory>

#include "pipeline/ranks/rank_exchange.hpp"

namespace raycell {

/// The connection between the ranks while one machine runs.
class RankSession : public RankTransport {
  public:
    /// Gives all ranks what rank 0 passes.
    virtual Bytes broadcast(const Bytes& from_rank_0) = 0;
    /// Ends the session once all ranks have called it.
    virtual void finish() = 0;
    /// Ends all ranks at once; mpirun's exit code will be `code`.
    [[noreturn]] virtual void abort(int code) = 0;
};

/// Joins the other processes that mpirun started. Throws RanksRefused in a program without MPI.
std::unique_ptr<RankSession> join_ranks();

}  // namespace raycell

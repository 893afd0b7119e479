#include "core/error.hpp"
#include "io/blocks.hpp"
#include "io/checkpoint.hpp"

namespace cdem {

PetscErrorCode CheckpointReader::ReadAudit(const CheckpointScene &scene, AuditArrays *audit) {
  PetscFunctionBeginUser;
  *audit = StartAudit(*scene.tables);
  std::vector<AuditRows> all;
  PetscCall(FindAuditRows(*scene.mesh, *scene.nodes, *scene.tables, &all));
  for (const AuditRows &rows : all) {
    const std::string name = rows.name + "/value";
    int width = 0;
    const std::int64_t total = file_->Rows(name, &width);
    CdemCheck(
        total == rows.total && width == rows.width, comm_,
        "%s: its %s are %lld rows of %d numbers, and this cdem has %lld of %d: it was written by another cdem; go "
        "on without -monitor_energy",
        path_.c_str(), rows.name.c_str(), static_cast<long long>(total), width, static_cast<long long>(rows.total),
        rows.width);
    PetscSF sf = nullptr;
    Hdf5Block b;
    PetscCall(CreateWantedBlocks(comm_, rows.wanted, rows.total, rows.name.c_str(), &sf, &b));
    std::vector<double> block(b.rows * static_cast<std::size_t>(rows.width));
    std::vector<double> values(rows.wanted.size() * static_cast<std::size_t>(rows.width));
    file_->Read(name, H5T_NATIVE_DOUBLE, static_cast<std::int64_t>(b.offset), static_cast<std::int64_t>(b.rows),
                block.data());
    PetscCall(file_->Check());
    PetscCall(FromBlock(sf, MPI_DOUBLE, rows.width, block, values.data()));
    PetscCall(PetscSFDestroy(&sf));
    PutAuditRows(rows, *scene.tables, values, audit);
  }
  PetscCall(ShareAudit(*scene.tables, audit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

}  // namespace cdem

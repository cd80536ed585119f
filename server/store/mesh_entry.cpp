#include "server/store/mesh_entry.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>

#include "server/store/descriptions.h"

namespace qtet {

void OpenMeshes::add(const EntryPointer& entry) {
  assert(entry);
  EntryPointer oldest;
  {
    const std::scoped_lock lock(mutex_);
    std::erase_if(held_, [&](const auto& weak) {
      const EntryPointer held = weak.lock();
      return !held || held == entry;
    });
    held_.push_back(entry);
    if (held_.size() <= most_) return;
    const auto use = [](const auto& weak) {
      const EntryPointer held = weak.lock();
      return held ? held->lastUse() : 0;
    };
    const auto least = std::ranges::min_element(held_, {}, use);
    oldest = least->lock();
    held_.erase(least);
    assert(held_.size() <= most_);
  }
  if (oldest) oldest->release();  // without the lock: closing a file may take its time
}

void OpenMeshes::releaseAll() {
  std::vector<std::weak_ptr<const MeshEntry>> all;
  {
    const std::scoped_lock lock(mutex_);
    all.swap(held_);
  }
  for (const auto& weak : all)
    if (const EntryPointer entry = weak.lock()) entry->release();
}

bool OpenMeshes::full() const {
  const std::scoped_lock lock(mutex_);
  return held_.size() >= most_;
}

MeshEntry::MeshEntry(const ServedMesh& mesh, std::filesystem::path where,
                     std::shared_ptr<OpenMeshes> open)
    : path(std::move(where)),
      id(mesh.id),
      digest(mesh.log.digest()),
      file(mesh.file),
      listEntry(describeEntry(mesh)),
      bytes(mesh.log.bytes().size()),
      tetrahedra(mesh.manifest.levels.back().tetrahedra),
      levels(mesh.manifest.levels.size()),
      openMeshes_(std::move(open)) {}

MeshPointer MeshEntry::open() const {
  lastUse_ = openMeshes_->nextUse();
  Result<MeshPointer> out = tryToOpen();
  if (!out) {
    openMeshes_->releaseAll();  // perhaps it is descriptors or memory that lack
    out = tryToOpen();
  }
  if (out) return *out;
  spdlog::warn("{}", out.error().text());
  return nullptr;
}

Result<MeshPointer> MeshEntry::tryToOpen() const {
  MeshPointer out;
  {
    // others who want it wait for the one who opens it
    const std::scoped_lock lock(mutex_);
    if (held_) return held_;
    out = lent_.lock();
    if (!out) {
      Result<MeshPointer> opened = reopenMesh(path, id, digest, file);
      if (!opened) return opened;
      out = std::move(*opened);
    }
    lent_ = held_ = out;
  }
  openMeshes_->add(shared_from_this());
  return out;
}

void MeshEntry::hold(MeshPointer mesh) const {
  assert(mesh && mesh->log.digest() == digest);
  lastUse_ = openMeshes_->nextUse();
  {
    const std::scoped_lock lock(mutex_);
    lent_ = mesh;
    held_ = std::move(mesh);
  }
  openMeshes_->add(shared_from_this());
}

void MeshEntry::release() const {
  MeshPointer gone;
  const std::scoped_lock lock(mutex_);
  if (!pinned_) gone.swap(held_);
}

bool MeshEntry::pin() const {
  const std::scoped_lock lock(mutex_);
  if (!held_) held_ = lent_.lock();
  pinned_ = held_ != nullptr;
  return pinned_;
}

}  // namespace qtet

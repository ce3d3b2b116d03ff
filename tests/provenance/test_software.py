"""Where a result comes from: the commit, also in a worktree and with packed references."""

import subprocess

import pytest

from burridge_knopoff.provenance import software


def git(folder, *command):
    identity = ("-c", "user.name=test", "-c", "user.email=test@example.org")
    done = subprocess.run(["git", *identity, *command], cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A repository with one commit; its package folder stands in for the real one."""

    def look(folder):
        monkeypatch.setattr(software, "PACKAGE", folder / "src" / "burridge_knopoff")
        software.git_commit.cache_clear()
        return software.git_commit()

    root = tmp_path / "root"
    root.mkdir()
    git(root, "init", "-q")
    git(root, "commit", "-q", "--allow-empty", "-m", "first")
    yield root, look
    software.git_commit.cache_clear()


def test_the_commit_of_a_checkout_a_worktree_and_a_detached_head(checkout):
    root, look = checkout
    commit = git(root, "rev-parse", "HEAD")
    assert look(root) == commit
    git(root, "worktree", "add", "-q", "-b", "other", "../other")
    assert look(root.parent / "other") == commit
    git(root.parent / "other", "commit", "-q", "--allow-empty", "-m", "second")
    second = git(root, "rev-parse", "other")
    assert look(root.parent / "other") == second != commit
    git(root, "pack-refs", "--all")
    assert (look(root), look(root.parent / "other")) == (commit, second)
    git(root, "checkout", "-q", "--detach")
    assert look(root) == commit


def test_no_checkout_has_no_commit(checkout, tmp_path):
    _, look = checkout
    assert look(tmp_path / "elsewhere") == "unknown"

//! File systems that send no events about changes made elsewhere.

use std::path::Path;

/// Kinds of network and host file systems. `fuse.` stands for all of its kinds (sshfs, rclone,
/// ...).
const SILENT: [&str; 16] = [
    "9p", "afs", "beegfs", "ceph", "cifs", "drvfs", "fuse.", "gpfs", "lustre", "ncpfs", "nfs",
    "nfs4", "prl_fs", "smb3", "vboxsf", "virtiofs",
];

/// Whether a folder is on such a file system.
pub(super) fn is_silent(folder: &Path) -> bool {
    // Other systems than Linux have no such table, and send events for network folders.
    let table = std::fs::read_to_string("/proc/self/mountinfo").unwrap_or_default();
    kind_of(folder, &table).is_some_and(|kind| {
        SILENT
            .iter()
            .any(|s| kind == *s || s.ends_with('.') && kind.starts_with(s))
    })
}

/// The kind of file system that a folder is on, by the table of mounts (proc_pid_mountinfo(5)).
fn kind_of<'a>(folder: &Path, table: &'a str) -> Option<&'a str> {
    let mounts = table.lines().filter_map(|line| {
        let (left, right) = line.split_once(" - ")?;
        // Blanks in names are written as \040.
        let at = left.split(' ').nth(4)?.replace("\\040", " ");
        folder
            .starts_with(&at)
            .then_some((at.len(), right.split(' ').next()?))
    });
    // The last of several mounts at one place is visible.
    mounts.max_by_key(|m| m.0).map(|m| m.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_innermost_mount_decides() {
        let table = "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n\
                     40 22 0:30 / /mnt/c rw - 9p drvfs rw\n\
                     41 22 0:31 / /home/a/far\\040away rw shared:2 - fuse.sshfs b: rw\n\
                     42 22 0:32 / /mnt/c/own rw - ext4 /dev/sdb rw\n";
        for (folder, kind) in [
            ("/work", "ext4"),
            ("/mnt/c/scenes", "9p"),
            ("/mnt/cd", "ext4"),
            ("/home/a/far away/b", "fuse.sshfs"),
            ("/mnt/c/own/x", "ext4"),
        ] {
            assert_eq!(kind_of(Path::new(folder), table), Some(kind), "{folder}");
        }
    }
}

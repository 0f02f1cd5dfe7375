//! Runs the real program and stops it before each system call that changes files: then the call is let through, is
//! made to fail, or the program is killed.
//!
//! A seccomp filter in the child hands these calls to us (`SECCOMP_RET_USER_NOTIF`, Linux 5.5, no privileges needed).
//! It works below every library, so calls that do not go through the C library are seen too.
#![expect(unsafe_code, reason = "there is no safe interface to seccomp")]

use crate::program::Run;
use std::ffi::c_long;
use std::io;
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

/// What becomes of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is carried out.
    Go,
    /// It is not carried out, and fails with this error.
    Fail(i32),
    /// The program is killed before it.
    Kill,
}

/// A call that the program is about to make.
#[derive(Debug, Clone, Copy)]
pub(super) struct Call {
    /// Its number.
    number: c_long,
    /// The thread that makes it.
    thread: u32,
    arguments: [u64; 6],
}

impl Call {
    /// The name of the call.
    pub(super) fn name(&self) -> &'static str {
        let known =
            WATCHED.iter().chain(&FORMER).chain(&[OPEN]).chain(&WRITES).find(|(number, _)| *number == self.number);
        known.map_or("another call", |(_, name)| name)
    }

    /// Whether it flushes a file or folder.
    pub(super) fn is_sync(&self) -> bool {
        [libc::SYS_fsync, libc::SYS_fdatasync].contains(&self.number)
    }

    /// The file or folder behind its first argument, a handle.
    pub(super) fn path_of_handle(&self) -> Option<PathBuf> {
        std::fs::read_link(format!("/proc/{}/fd/{}", self.thread, self.arguments[0])).ok()
    }
}

/// Calls that are always watched.
const WATCHED: [(c_long, &str); 14] = [
    (libc::SYS_renameat, "renameat"),
    (libc::SYS_renameat2, "renameat2"),
    (libc::SYS_unlinkat, "unlinkat"),
    (libc::SYS_mkdirat, "mkdirat"),
    (libc::SYS_linkat, "linkat"),
    (libc::SYS_symlinkat, "symlinkat"),
    (libc::SYS_ftruncate, "ftruncate"),
    (libc::SYS_fallocate, "fallocate"),
    (libc::SYS_fsync, "fsync"),
    (libc::SYS_fdatasync, "fdatasync"),
    (libc::SYS_copy_file_range, "copy_file_range"),
    (libc::SYS_sendfile, "sendfile"),
    (libc::SYS_fchmod, "fchmod"),
    (libc::SYS_fchmodat, "fchmodat"),
];

/// Calls of the same meaning that only older processors have.
#[cfg(target_arch = "x86_64")]
const FORMER: [(c_long, &str); 5] = [
    (libc::SYS_rename, "rename"),
    (libc::SYS_unlink, "unlink"),
    (libc::SYS_rmdir, "rmdir"),
    (libc::SYS_mkdir, "mkdir"),
    (libc::SYS_chmod, "chmod"),
];
#[cfg(not(target_arch = "x86_64"))]
const FORMER: [(c_long, &str); 0] = [];

/// Watched where it opens for writing.
const OPEN: (c_long, &str) = (libc::SYS_openat, "openat");

/// Watched but for the standard input and outputs.
const WRITES: [(c_long, &str); 4] = [
    (libc::SYS_write, "write"),
    (libc::SYS_pwrite64, "pwrite64"),
    (libc::SYS_writev, "writev"),
    (libc::SYS_pwritev, "pwritev"),
];

/// Runs the program; `decide` is asked before each watched call, with its number from 0. `None` where the system does
/// not allow such filters, said loudly.
pub(super) fn run(command: Command, mut decide: impl FnMut(usize, &Call) -> Verdict) -> Option<Run> {
    let (child, listener) = match start(command) {
        Ok(started) => started,
        Err(error) => {
            eprintln!("skipped: the system allows no seccomp filter with a listener here ({error})");
            return None;
        }
    };
    let mut child = Guard(child);
    let mut count = 0;
    while let Some(notice) = next(&listener) {
        let call = Call { number: notice.data.nr.into(), thread: notice.pid, arguments: notice.data.args };
        match decide(count, &call) {
            Verdict::Go => answer(&listener, notice.id, 0, libc::SECCOMP_USER_NOTIF_FLAG_CONTINUE as u32),
            Verdict::Fail(error) => answer(&listener, notice.id, -error, 0),
            Verdict::Kill => child.0.kill().expect("our own child"),
        }
        count += 1;
    }
    let (status, streams) = (child.0.wait().expect("our own child"), (child.0.stdout.take(), child.0.stderr.take()));
    let text = |stream: Option<&mut dyn io::Read>| {
        let mut text = String::new();
        stream.map(|stream| stream.read_to_string(&mut text));
        text
    };
    let (mut out, mut err) = streams;
    Some(Run {
        code: status.code().unwrap_or(-1),
        stdout: text(out.as_mut().map(|out| out as &mut dyn io::Read)),
        stderr: text(err.as_mut().map(|err| err as &mut dyn io::Read)),
    })
}

/// Ends the program if a test fails while it waits for us.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts the program under the filter; returns the handle on which its calls arrive.
fn start(mut command: Command) -> io::Result<(Child, OwnedFd)> {
    let filter = filter();
    let (ours, theirs) = UnixStream::pair()?;
    let socket = theirs.as_raw_fd();
    // SAFETY: between fork and exec only system calls are made, on memory that was made before; nothing is allocated.
    unsafe {
        command.pre_exec(move || send(socket, install(&filter)?));
    }
    // What the program says in these tests is less than a pipe holds, so nobody needs to read it meanwhile.
    let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    drop(theirs);
    let listener = receive(ours.as_raw_fd())?;
    // We and the program take turns: on one processor that is ten times as quick. Linux before 6.6 does not know it.
    // SAFETY: the call reads the flags alone.
    unsafe { libc::ioctl(listener.as_raw_fd(), SET_FLAGS, SYNC_WAKE_UP) };
    Ok((child, listener))
}

/// The filter: which calls are handed to us.
fn filter() -> Vec<libc::sock_filter> {
    const LOAD: u16 = (libc::BPF_LD | libc::BPF_W | libc::BPF_ABS) as u16;
    const IF_EQUAL: u16 = (libc::BPF_JMP | libc::BPF_JEQ | libc::BPF_K) as u16;
    const IF_GREATER: u16 = (libc::BPF_JMP | libc::BPF_JGT | libc::BPF_K) as u16;
    const AND: u16 = (libc::BPF_ALU | libc::BPF_AND | libc::BPF_K) as u16;
    const RETURN: u16 = (libc::BPF_RET | libc::BPF_K) as u16;
    let step = |code, k: u32| libc::sock_filter { code, jt: 0, jf: 0, k };
    let notify = step(RETURN, libc::SECCOMP_RET_USER_NOTIF);
    let allow = step(RETURN, libc::SECCOMP_RET_ALLOW);
    // The low half of argument `n` in `seccomp_data`, which begins with 16 bytes of number, processor and address.
    let argument = |n: u32| step(LOAD, 16 + 8 * n + if cfg!(target_endian = "big") { 4 } else { 0 });
    let branch = |code, k: u32, jt, jf| libc::sock_filter { code, jt, jf, k };

    let mut program = vec![step(LOAD, 0)];
    for (number, _) in WATCHED.iter().chain(&FORMER) {
        program.extend([branch(IF_EQUAL, *number as u32, 0, 1), notify]);
    }
    for (number, _) in WRITES {
        program.extend([
            branch(IF_EQUAL, number as u32, 0, 4),
            argument(0),
            branch(IF_GREATER, 2, 0, 1),
            notify,
            allow,
        ]);
    }
    let writing = (libc::O_WRONLY | libc::O_RDWR | libc::O_CREAT | libc::O_TRUNC) as u32;
    program.extend([
        branch(IF_EQUAL, OPEN.0 as u32, 0, 5),
        argument(2),
        step(AND, writing),
        branch(IF_EQUAL, 0, 1, 0),
        notify,
        allow,
        allow,
    ]);
    program
}

/// `SECCOMP_IOCTL_NOTIF_SET_FLAGS` and `SECCOMP_USER_NOTIF_FD_SYNC_WAKE_UP` of the kernel.
const SET_FLAGS: libc::Ioctl = 0x4008_2104;
const SYNC_WAKE_UP: c_long = 1;

/// Puts the filter on the calling thread and on all that it starts.
fn install(filter: &[libc::sock_filter]) -> io::Result<RawFd> {
    let program = libc::sock_fprog { len: filter.len() as u16, filter: filter.as_ptr().cast_mut() };
    // SAFETY: the program lives until the call returns; the kernel copies it.
    let handle = unsafe {
        if libc::prctl(libc::PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 {
            return Err(io::Error::last_os_error());
        }
        libc::syscall(
            libc::SYS_seccomp,
            libc::SECCOMP_SET_MODE_FILTER as c_long,
            libc::SECCOMP_FILTER_FLAG_NEW_LISTENER as c_long,
            &raw const program,
        )
    };
    if handle < 0 { Err(io::Error::last_os_error()) } else { Ok(handle as RawFd) }
}

/// Room for a message that carries one handle.
#[repr(C, align(8))]
struct Control([u8; 64]);

/// A message of `data` that has room for one handle; it points to both.
fn message(data: &mut libc::iovec, control: &mut Control) -> libc::msghdr {
    // SAFETY: a message of zeros is an empty one.
    let mut message: libc::msghdr = unsafe { std::mem::zeroed() };
    message.msg_iov = data;
    message.msg_iovlen = 1;
    message.msg_control = control.0.as_mut_ptr().cast();
    message.msg_controllen = control.0.len() as _;
    message
}

/// Sends a handle to the process at the other end of the socket.
fn send(socket: RawFd, handle: RawFd) -> io::Result<()> {
    let mut byte = [0u8; 1];
    let mut data = libc::iovec { iov_base: byte.as_mut_ptr().cast(), iov_len: 1 };
    let mut control = Control([0; 64]);
    // SAFETY: all pointers in the message are to locals that outlive the call, and the header lies within `control`.
    unsafe {
        let mut message = message(&mut data, &mut control);
        message.msg_controllen = libc::CMSG_SPACE(size_of::<RawFd>() as u32) as _;
        let header = libc::CMSG_FIRSTHDR(&raw const message);
        (*header).cmsg_level = libc::SOL_SOCKET;
        (*header).cmsg_type = libc::SCM_RIGHTS;
        (*header).cmsg_len = libc::CMSG_LEN(size_of::<RawFd>() as u32) as _;
        libc::CMSG_DATA(header).cast::<RawFd>().write_unaligned(handle);
        if libc::sendmsg(socket, &raw const message, 0) == 1 { Ok(()) } else { Err(io::Error::last_os_error()) }
    }
}

/// Receives the handle that [`send`] has sent.
fn receive(socket: RawFd) -> io::Result<OwnedFd> {
    let mut byte = [0u8; 1];
    let mut data = libc::iovec { iov_base: byte.as_mut_ptr().cast(), iov_len: 1 };
    let mut control = Control([0; 64]);
    // SAFETY: as in `send`; the handle that arrives belongs to nobody else.
    unsafe {
        let mut message = message(&mut data, &mut control);
        if libc::recvmsg(socket, &raw mut message, libc::MSG_CMSG_CLOEXEC) != 1 {
            return Err(io::Error::last_os_error());
        }
        let header = libc::CMSG_FIRSTHDR(&raw const message);
        if header.is_null() {
            return Err(io::Error::other("no handle was sent"));
        }
        Ok(OwnedFd::from_raw_fd(libc::CMSG_DATA(header).cast::<RawFd>().read_unaligned()))
    }
}

/// Waits for the next call; `None` when the program has ended.
fn next(listener: &OwnedFd) -> Option<libc::seccomp_notif> {
    const PATIENCE_MS: i32 = 120_000;
    loop {
        let mut poll = libc::pollfd { fd: listener.as_raw_fd(), events: libc::POLLIN, revents: 0 };
        // SAFETY: `poll` is one record, and `notice` is as large as the kernel's, and zeroed as it asks for.
        unsafe {
            let ready = libc::poll(&raw mut poll, 1, PATIENCE_MS);
            assert!(ready > 0, "the program does nothing any more");
            if poll.revents & libc::POLLIN == 0 {
                return None;
            }
            let mut notice: libc::seccomp_notif = std::mem::zeroed();
            if libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_RECV, &raw mut notice) == 0 {
                return Some(notice);
            }
            // The thread was ended by a signal before its call could be read.
        }
    }
}

fn answer(listener: &OwnedFd, id: u64, error: i32, flags: u32) {
    let answer = libc::seccomp_notif_resp { id, val: 0, error, flags };
    // SAFETY: the record is the kernel's; a thread that has ended meanwhile is an error that means nothing.
    unsafe { libc::ioctl(listener.as_raw_fd(), libc::SECCOMP_IOCTL_NOTIF_SEND, &raw const answer) };
}

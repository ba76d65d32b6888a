"""Makes and runs the kernel machine: Debian's own kernel and udev under QEMU, and an initramfs that
holds nothing but busybox, the shipped programs with their libraries, and the modules for HID.
"""
import os
import pathlib
import re
import select
import shutil
import subprocess
import time

HERE = pathlib.Path(__file__).resolve().parent
MODULES = ("uhid", "hid-wiimote", "hid-generic", "hid-sony", "hid-playstation", "hid-nintendo", "evdev")
KEPT_DRIVERS = ("hid", "input", "leds", "usb")  # What those depend on, too.
TOOLS = ("qemu-system-x86_64", "busybox", "cpio", "depmod", "dpkg-deb", "apt-get", "ldd")
BEGIN, END = "footing-vm: results begin", "footing-vm: results end"


class Missing(Exception):
    """What the machine needs is not to be had here; the test is skipped, and says why."""


def find_tool(name):
    found = shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    if not found:
        raise Missing(f"{name} is not installed; install what scripts/dependencies-vm.txt lists")
    return found


def run(*words, **options):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True,
                          timeout=300, stdin=subprocess.DEVNULL, **options).stdout


def kernel_package():
    depends = run("apt-cache", "depends", "--no-recommends", "linux-image-amd64")
    found = re.search(r"Depends: (linux-image-\S+)", depends)
    if not found:
        raise Missing("apt knows no linux-image-amd64; try apt-get update")
    return found[1]


def fetch_packages(folder):
    """Unpacks Debian's kernel and udev below the folder; installs nothing."""
    root = folder / "root"
    packages = (kernel_package(), "udev", "libsystemd-shared", "libkmod2")
    done, content = folder / "unpacked", [*packages, *KEPT_DRIVERS]
    if done.exists() and done.read_text().split() == content:
        return root
    shutil.rmtree(folder, ignore_errors=True)
    root.mkdir(parents=True)
    try:
        run("apt-get", "download", *packages, cwd=folder)
    except subprocess.CalledProcessError as error:
        raise Missing("cannot download " + " ".join(packages) + ": " + error.stderr.strip()) from error
    for package in folder.glob("*.deb"):
        run("dpkg-deb", "-x", package, root)
        package.unlink()
    # Of the kernel's 400 MB only these are ever needed.
    for folder_of_modules in root.glob("lib/modules/*/kernel/*"):
        if folder_of_modules.name != "drivers":
            shutil.rmtree(folder_of_modules)
    for drivers in root.glob("lib/modules/*/kernel/drivers/*"):
        if drivers.name not in KEPT_DRIVERS:
            shutil.rmtree(drivers)
    done.write_text("\n".join(content))
    return root


def add_modules(folder, packages, names):
    """Puts kernel modules into a root file system, with those that they need."""
    version = next((packages / "lib/modules").iterdir()).name
    run(find_tool("depmod"), "-b", packages, version)
    base, target = packages / "lib/modules" / version, folder / "lib/modules" / version
    depends = {}
    for line in (base / "modules.dep").read_text().splitlines():
        module, _, others = line.partition(":")
        depends[pathlib.Path(module).name.removesuffix(".ko").replace("_", "-")] = [module, *others.split()]
    files = [module for name in names for module in depends[name]]  # Itself, then what it needs.
    for file in (*files, "modules.order", "modules.builtin", "modules.builtin.modinfo"):
        (target / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(base / file, target / file)
    run(find_tool("depmod"), "-b", folder, version)


class Image:
    """The initramfs in the making."""

    def __init__(self, folder, packages):
        self.folder, self.packages = folder, packages
        shutil.rmtree(folder, ignore_errors=True)
        for name in ("bin", "dev", "etc", "lib64", "proc", "run", "sys", "tmp", "var/lib"):
            (folder / name).mkdir(parents=True)
        (folder / "usr").mkdir()
        (folder / "usr/lib").symlink_to("../lib")  # As Debian has it.
        self.libraries = [packages / "usr/lib/x86_64-linux-gnu", packages / "lib/x86_64-linux-gnu",
                          packages / "usr/lib/x86_64-linux-gnu/systemd"]

    def add(self, source, target):
        target = self.folder / target
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)

    def add_program(self, source, name=None):
        """With every library that it loads."""
        self.add(source, f"bin/{name or pathlib.Path(source).name}")
        path = ":".join(map(str, self.libraries))
        for line in run("ldd", source, env={**os.environ, "LD_LIBRARY_PATH": path}).splitlines():
            words = line.split()
            if "not found" in line:
                raise Missing(f"{source} needs the library {words[0]}")
            library = next((word for word in words if word.startswith("/")), None)
            if not library:
                continue
            # The loader has a fixed place; everything else is found in /lib.
            loader = pathlib.Path(library).name.startswith("ld-linux")
            target = f"lib64/{pathlib.Path(library).name}" if loader else f"lib/{pathlib.Path(library).name}"
            if not (self.folder / target).exists():
                self.add(library, target)

    def pack(self, target):
        names = subprocess.run(["find", "."], cwd=self.folder, check=True, capture_output=True).stdout
        archive = subprocess.run(["cpio", "-o", "-H", "newc", "--quiet", "-R", "0:0"], input=names,
                                 cwd=self.folder, check=True, capture_output=True).stdout
        target.write_bytes(archive)


def make_image(build, source, packages, folder):
    image = Image(folder / "image", packages)
    image.add(find_tool("busybox"), "bin/busybox")
    image.add(HERE / "init", "init")
    (image.folder / "init").chmod(0o755)
    for program in ("footingd", "footing-ctl", "footing-log"):
        image.add_program(build / "bin" / program)
    for program in ("kernel_device", "stream_client"):
        image.add_program(build / "tests" / program)
    image.add_program(packages / "bin/udevadm")
    # udevd finds out by its name what it is.
    (image.folder / "bin/systemd-udevd").symlink_to("udevadm")
    for rules in (packages / "lib/udev/rules.d").iterdir():
        image.add(rules, f"lib/udev/rules.d/{rules.name}")
    image.add(source / "systemd/70-footing.rules", "lib/udev/rules.d/70-footing.rules")
    (image.folder / "etc/passwd").write_text("root:x:0:0::/:/bin/sh\nfooting:x:990:990::/:/bin/sh\n")
    groups = ("tty 5", "disk 6", "dialout 20", "cdrom 24", "audio 29", "video 44", "input 104",
              "kvm 105", "render 106", "sgx 107", "lp 7", "tape 26", "kmem 15", "footing 990", "root 0")
    (image.folder / "etc/group").write_text(
        "".join("{}:x:{}:\n".format(*group.split()) for group in groups))
    add_modules(image.folder, packages, MODULES)
    target = folder / "initramfs.cpio"
    image.pack(target)
    return target


def boot(kernel, initramfs, accelerator, arguments, first_word_s, all_s, memory_mb=768):
    """Runs the machine to its end. Its console's text; None when it never came up."""
    processor = {"kvm": "max,-arch-capabilities", "tcg": "max"}[accelerator]
    command = [find_tool("qemu-system-x86_64"), "-M", "pc", "-accel", accelerator, "-cpu", processor,
               "-smp", "2", "-m", str(memory_mb), "-nodefaults", "-display", "none", "-serial", "stdio",
               "-no-reboot", "-kernel", str(kernel), "-initrd", str(initramfs),
               "-append", f"console=ttyS0 quiet panic=-1 rdinit=/init {arguments}"]
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT)
    console, begin = b"", time.monotonic()
    try:
        while time.monotonic() - begin < all_s:
            if b"footing-vm: up" not in console and time.monotonic() - begin > first_word_s:
                break
            if not select.select([process.stdout], [], [], 1)[0]:
                continue
            piece = os.read(process.stdout.fileno(), 65536)
            if not piece:
                break
            console += piece
    finally:
        process.kill()
        process.wait()
    text = console.decode("utf-8", "replace").replace("\r", "")
    return text if "footing-vm: up" in text else None


def run_machine(build, source, only=""):
    """Console text and the accelerator that ran it. `only`: scenarios, between commas."""
    for tool in TOOLS:
        find_tool(tool)
    folder = build / "vm"
    packages = fetch_packages(folder / "packages")
    kernel = next((packages / "boot").glob("vmlinuz-*"))
    initramfs = make_image(build, source, packages, folder)
    return boot_as_can_be(kernel, initramfs, f"only={only}", {"kvm": 850, "tcg": 1000})


def boot_as_can_be(kernel, initramfs, arguments, all_s, memory_mb=768):
    """Console text and the accelerator that ran it, within all_s[accelerator] seconds."""
    # The hardware's own virtualisation where it works; TCG translates every instruction.
    if os.access("/dev/kvm", os.R_OK | os.W_OK) and os.environ.get("FOOTING_VM") != "tcg":
        text = boot(kernel, initramfs, "kvm", arguments, 20, all_s["kvm"], memory_mb)
        if text:
            return text, "kvm"
    text = boot(kernel, initramfs, "tcg", arguments, 180, all_s["tcg"], memory_mb)
    if not text:
        raise RuntimeError("the machine did not come up within 180 s")
    return text, "tcg"

# 20 x 20 x 10 mm box with a round hole of 8 mm through it along z, standing on z = 0 around the origin; binary STL.
import math,struct,sys
half,height,r,n=10.0,10.0,4.0,96
circle=[(r*math.cos(2*math.pi*i/n),r*math.sin(2*math.pi*i/n)) for i in range(n)]
def outer(i):
    a=2*math.pi*i/n; c,s=math.cos(a),math.sin(a); k=half/max(abs(c),abs(s)); return (k*c,k*s)
edge=[outer(i) for i in range(n)]  # n is a multiple of 8: the corners are among them
t=[]
for i in range(n):
    j=(i+1)%n
    a,b,c,d=edge[i],edge[j],circle[i],circle[j]
    for z,up in((height,True),(0.0,False)):
        q=[(*a,z),(*b,z),(*d,z),(*c,z)]
        if not up:q=q[::-1]
        t+= [(q[0],q[1],q[2]),(q[0],q[2],q[3])]
    t+=[((*a,0.),(*b,0.),(*b,height)),((*a,0.),(*b,height),(*a,height))]
    t+=[((*d,0.),(*c,0.),(*c,height)),((*d,0.),(*c,height),(*d,height))]
with open(sys.argv[1],'wb') as f:
    f.write(b'box with a hole'.ljust(80)); f.write(struct.pack('<I',len(t)))
    for tri in t: f.write(struct.pack('<12fH',0,0,0,*tri[0],*tri[1],*tri[2],0))
